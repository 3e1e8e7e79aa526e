/* One step of Rodas4, stage by stage, as `rodas.py` writes it out: for derivatives, and where code must be small. */
#ifndef WC_RODAS_H
#define WC_RODAS_H

#include "tangent.h"

#define WC_STAGES 6

/* What is given is named on its own; the rest is found by wc_rodas_begin and wc_rodas_stage. */
typedef struct {
    const wc_kernel *k;
    const wc_tangent *g;
    const double *p, *mass, *x, *w0, *w1;
    double h;
} wc_rodas_given;

typedef struct {
    wc_rodas_given of;
    double first[WC_MAX_STATES * (WC_MAX_STATES + WC_PUSHES)]; /* slopes where the step begins */
    double W[WC_MAX_STATES * WC_MAX_STATES];                   /* M/(hγ) - J as factors */
    double ramp[WC_MAX_STATES];                                /* h ∂f/∂t */
    double U[WC_STAGES * WC_MAX_STATES];                       /* stage by stage, rows of k->states */
    double xs[WC_MAX_STATES], ws[WC_MAX_INPUTS];               /* where the last stage was taken */
    int exchange[WC_MAX_STATES];
} wc_rodas;

void wc_rodas_begin(wc_rodas *s, wc_rodas_given of);

void wc_rodas_stage(wc_rodas *s, int i);

/* After the last stage: the step's end, and its error. */
void wc_rodas_end(const wc_rodas *s, double *x1, double *error);

/* Wᵀ k = right for m right sides at once, in place; rows of `right` are contiguous. */
void wc_rodas_solve_transposed(const wc_rodas *s, int m, double *right);

/* The whole step: what a kernel's `step` gives, x1, error, d2, d3. */
void wc_rodas_step(wc_rodas_given of, double **result);

/* to += factor from, m numbers. */
static inline void wc_add_row(int m, double factor, const double *restrict from, double *restrict to) {
    if (factor == 0) return;
    for (int c = 0; c < m; c++) to[c] += factor * from[c];
}

/* to += Σ a_j U_j over the first stages, for values or for directions (`rows` numbers each). */
static inline void wc_add_stages(int rows, const double *a, int stages, const double *U, double *to) {
    for (int j = 0; j < stages; j++) wc_add_row(rows, a[j], U + (long)j * rows, to);
}

#endif
