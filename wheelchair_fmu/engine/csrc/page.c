/* What the report's page calls of a model: its run, with plain arguments, and what page_evaluation.c calls.
 *
 * Compiled to WebAssembly. Nothing is imported and nothing allocated: the page hands out addresses in
 * the module's own memory, behind what both modules have there. */
#include "rodas.h"

#define EXPORT(name) __attribute__((export_name(#name))) name

extern const wc_kernel model_kernel;
extern const wc_tangent tangent_tangent;
extern unsigned char __heap_base;

unsigned char *EXPORT(wc_page_heap)(void) { return &__heap_base; }

const wc_kernel *EXPORT(wc_page_kernel)(void) { return &model_kernel; }

const wc_tangent *EXPORT(wc_page_tangent)(void) { return &tangent_tangent; }

/* The kernel's step, for all of this module's runs. */
int wc_page_step(const double **arg, double **res, long long *iw, double *work, int mem) {
    (void)iw, (void)work, (void)mem;
    double mass[WC_MAX_STATES];
    double *masses[] = {mass};
    model_kernel.mass(&arg[4], masses, 0, 0, 0);
    wc_rodas_step((wc_rodas_given){.k = &model_kernel, .g = &tangent_tangent, .mass = mass, .x = arg[0], .w0 = arg[1],
                                   .w1 = arg[2], .h = *arg[3], .p = arg[4]}, res);
    return 0;
}

/* From the parameters' own start; see wc_run. */
int EXPORT(wc_page_run)(const double *p, double tolerance, double grid, long n, const double *t, const double *w, double *x,
                        double *y, long *reached) {
    wc_accuracy accuracy = {tolerance, grid};
    long steps = 0;
    *reached = 0;
    wc_status status = wc_start(&model_kernel, p, w, x);
    return status != WC_OK ? status : wc_run(&model_kernel, p, accuracy, n, t, w, 0, x, y, reached, &steps);
}

/* From where evaluation.c begins, and on; see advance.h and tangent.h. */
wc_status EXPORT(wc_page_start)(const wc_kernel *k, const double *p, const double *w, double *x) { return wc_start(k, p, w, x); }

wc_status EXPORT(wc_page_advance)(const wc_kernel *k, const double *p, const wc_accuracy *accuracy, long n, const double *t,
                                  const double *w, double *x, double *y, long *reached, long *steps) {
    return wc_run(k, p, *accuracy, n, t, w, 0, x, y, reached, steps);
}

wc_status EXPORT(wc_page_linearise)(const wc_kernel *k, const wc_tangent *g, const double *p, double tolerance, long n,
                                    const double *t, const double *w, double *x, double *y, const wc_derivatives *out, double *work,
                                    long *reached) {
    return wc_tangent_run(k, g, p, tolerance, n, t, w, x, y, out, work, reached);
}

long EXPORT(wc_page_work)(const wc_kernel *k, const wc_tangent *g, int active) { return wc_tangent_work(k, g, active); }
