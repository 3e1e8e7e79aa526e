/* What the report's page calls: one model's run, its derivatives and its whitening, with plain arguments.
 *
 * Compiled to WebAssembly. Nothing is imported and nothing allocated: the page hands out addresses in
 * the module's own memory, from wc_page_heap() on. */
#include "innovations.c"
#include "rodas.h"

#define EXPORT(name) __attribute__((export_name(#name))) name

extern const wc_kernel model_kernel;
extern const wc_tangent tangent_tangent;
extern unsigned char __heap_base;

unsigned char *EXPORT(wc_page_heap)(void) { return &__heap_base; }

long EXPORT(wc_page_work)(int active) { return wc_tangent_work(&model_kernel, &tangent_tangent, active); }

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

/* `out` is a record of pointers that the page has filled in; see wc_tangent_run. */
int EXPORT(wc_page_linearise)(const double *p, double tolerance, long n, const double *t, const double *w, double *x,
                              double *y, const wc_derivatives *out, double *work, long *reached) {
    return wc_tangent_run(&model_kernel, &tangent_tangent, p, tolerance, n, t, w, x, y, out, work, reached);
}

/* `f` is a record that the page has filled in; see innovations.c. */
void EXPORT(wc_page_design)(const filter *f, long n, double *gain, double *scale) { wc_design(f, n, gain, scale); }

void EXPORT(wc_page_whiten)(const filter *f, long n, const double *gain, const double *scale, const double *start_mean,
                            int m, double *signals, double *work) {
    wc_whiten(f, n, gain, scale, start_mean, m, signals, work);
}

void EXPORT(wc_page_spread)(const filter *f, long n, double *scale) { wc_spread(f, n, scale); }

/* The states of every model begin with x, y, psi, u, v. */
void EXPORT(wc_page_drop_kinks)(const filter *f, long n, double dt) { wc_drop_kinks(f, n, dt, 3, 4); }
