/* What the report's page calls to evaluate a run, with plain arguments; see evaluation.h.
 *
 * Compiled to WebAssembly, once for all models of a page: it works in the memory of a model, far enough from what that has there,
 * and calls it. The page hands out addresses from wc_page_free() on, and fills records in as words. */
#include "evaluation.h"

#define EXPORT(name) __attribute__((export_name(#name))) name
#define IMPORT(name) __attribute__((import_module("model"), import_name(#name))) name

extern unsigned char __heap_base;

unsigned char *EXPORT(wc_page_free)(void) { return &__heap_base; }

wc_status IMPORT(wc_page_start)(const wc_kernel *k, const double *p, const double *w, double *x);
wc_status IMPORT(wc_page_advance)(const wc_kernel *k, const double *p, const wc_accuracy *accuracy, long n, const double *t,
                                  const double *w, double *x, double *y, long *reached, long *steps);
wc_status IMPORT(wc_page_linearise)(const wc_kernel *k, const wc_tangent *g, const double *p, double tolerance, long n,
                                    const double *t, const double *w, double *x, double *y, const wc_derivatives *out, double *work,
                                    long *reached);
long IMPORT(wc_page_work)(const wc_kernel *k, const wc_tangent *g, int active);

wc_status wc_start(const wc_kernel *k, const double *p, const double *w, double *x) { return wc_page_start(k, p, w, x); }

wc_status wc_run(const wc_kernel *k, const double *p, wc_accuracy accuracy, long n, const double *t, const double *w, int hold,
                 double *x, double *y, long *reached, long *steps) {
    (void)hold; /* an evaluation's inputs are linear between samples */
    return wc_page_advance(k, p, &accuracy, n, t, w, x, y, reached, steps);
}

wc_status wc_tangent_run(const wc_kernel *k, const wc_tangent *g, const double *p, double tolerance, long n, const double *t,
                         const double *w, double *x, double *y, const wc_derivatives *out, double *work, long *reached) {
    return wc_page_linearise(k, g, p, tolerance, n, t, w, x, y, out, work, reached);
}

long wc_tangent_work(const wc_kernel *k, const wc_tangent *g, int active) { return wc_page_work(k, g, active); }

/* How many doubles hold a record. */
long EXPORT(wc_page_record)(void) { return sizeof(wc_evaluation) / sizeof(double) + 1; }

/* `pushed`: the errors of the pushes that were found, or 0. */
void EXPORT(wc_page_room)(const wc_recording *s, wc_evaluation *e, double *kept, double *work, long *rooms, const double *pushed) {
    wc_evaluation_room(s, e, kept, work, rooms);
    e->pushed = pushed;
}

long EXPORT(wc_page_pushes_room)(const wc_recording *s) { return wc_pushes_room(s); }

long EXPORT(wc_page_again_room)(const wc_recording *s, wc_simulated *to, double *block) { return wc_simulated_room(s, to, block); }

/* errors, work: see wc_follow_pushes(); 0 where no caster may swing round. */
int EXPORT(wc_page_evaluate)(const wc_recording *s, const wc_values *v, wc_evaluation *e, int expected, int rounds, double *errors,
                             double *work) {
    if (expected) {
        wc_expected(s, e);
        e->pushed = 0;
    }
    int status = wc_evaluate(s, v, e, rounds);
    if (status == WC_OK && errors && rounds) status = wc_follow_pushes(s, v, e, errors, work);
    if (status == WC_OK) wc_find_spread(s, e);
    return status;
}

int EXPORT(wc_page_again)(const wc_recording *s, const wc_values *v, wc_evaluation *e, int kept, wc_simulated *to) {
    return wc_again(s, v, e, kept, e->x, to);
}

const double *EXPORT(wc_page_pushed)(const wc_evaluation *e) { return e->pushed; }

long EXPORT(wc_page_reached)(const wc_evaluation *e) { return *e->reached; }

/* shown, sd: n x nz, readings as sensors give them, and their standard deviations where the model is right. */
void EXPORT(wc_page_tell)(const wc_recording *s, const wc_values *v, const wc_evaluation *e, const wc_simulated *of, double *shown,
                          double *sd, double *errors, double *sums) {
    wc_as_read(s, v, of->predicted, shown);
    for (long at = 0; at < s->n * s->noise.nz; at++) sd[at] = 1 / e->spread[at];
    wc_errors(s, v, e, of, errors, sums);
}

void EXPORT(wc_page_as_read)(const wc_recording *s, const wc_values *v, const wc_simulated *of, double *to) {
    wc_as_read(s, v, of->predicted, to);
}

void EXPORT(wc_page_normal)(const wc_recording *s, const wc_evaluation *e, int k, const double *steps, const double *moved,
                            double *jtj, double *jtr, double *squares) {
    wc_normal(s, e, k, steps, moved, jtj, jtr, squares);
}

void EXPORT(wc_page_doubt)(const wc_recording *s, int k, const double *base, const double *steps, const double *moved,
                           const double *covariance, double *variance) {
    wc_doubt(s, k, base, steps, moved, covariance, variance);
}
