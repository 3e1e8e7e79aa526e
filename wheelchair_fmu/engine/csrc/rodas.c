#include "rodas.h"

#include <math.h>
#include <string.h>

/* W = L U in place, with row exchanges. */
static void factorise(int n, double *W, int *exchange) {
    for (int c = 0; c < n; c++) {
        int best = c;
        for (int r = c + 1; r < n; r++) {
            if (fabs(W[r * n + c]) > fabs(W[best * n + c])) best = r;
        }
        exchange[c] = best;
        for (int j = 0; best != c && j < n; j++) {
            double kept = W[c * n + j];
            W[c * n + j] = W[best * n + j];
            W[best * n + j] = kept;
        }
        double inverse = W[c * n + c] = 1 / W[c * n + c]; /* which is all that is asked of it */
        for (int r = c + 1; r < n; r++) {
            if (W[r * n + c] == 0) continue;
            double f = W[r * n + c] *= inverse;
            for (int j = c + 1; j < n; j++) W[r * n + j] -= f * W[c * n + j];
        }
    }
}

void wc_rodas_solve_transposed(const wc_rodas *s, int m, double *right) {
    int n = s->of.k->states;
    const double *W = s->W;
    for (int c = 0; c < n; c++) {
        for (int j = 0; j < m; j++) right[c * m + j] *= W[c * n + c];
        for (int r = c + 1; r < n; r++) wc_add_row(m, -W[c * n + r], right + c * m, right + r * m);
    }
    for (int c = n - 1; c >= 0; c--) {
        for (int r = 0; r < c; r++) wc_add_row(m, -W[c * n + r], right + c * m, right + r * m);
    }
    for (int c = n - 1; c >= 0; c--) { /* L was exchanged whole, so all exchanges come last */
        int from = s->exchange[c];
        for (int j = 0; from != c && j < m; j++) {
            double kept = right[c * m + j];
            right[c * m + j] = right[from * m + j];
            right[from * m + j] = kept;
        }
    }
}

/* W k = right, which every step asks for six times. */
static void solve_one(const wc_rodas *s, double *k) {
    int n = s->of.k->states;
    for (int c = 0; c < n; c++) {
        double kept = k[c];
        k[c] = k[s->exchange[c]];
        k[s->exchange[c]] = kept;
    }
    for (int r = 1; r < n; r++) {
        const double *row = s->W + r * n;
        double sum = k[r];
        for (int c = 0; c < r; c++) sum -= row[c] * k[c];
        k[r] = sum;
    }
    for (int r = n - 1; r >= 0; r--) {
        const double *row = s->W + r * n;
        double sum = k[r];
        for (int c = r + 1; c < n; c++) sum -= row[c] * k[c];
        k[r] = sum * row[r];
    }
}

void wc_rodas_begin(wc_rodas *s, wc_rodas_given of) {
    s->of = of;
    int nx = s->of.k->states, span = nx + WC_PUSHES;
    double dw[WC_MAX_INPUTS];
    for (int q = 0; q < s->of.k->inputs; q++) dw[q] = s->of.w1[q] - s->of.w0[q];
    const double *arg[] = {s->of.x, s->of.w0, s->of.p, dw};
    double *first[] = {s->first}, *ramp[] = {s->ramp};
    s->of.g->slopes(arg, first, 0, 0, 0);
    s->of.g->ramp(arg, ramp, 0, 0, 0);
    for (int r = 0; r < nx; r++) {
        for (int c = 0; c < nx; c++) s->W[r * nx + c] = -s->first[r * span + c];
        s->W[r * nx + r] += s->of.mass[r] / (s->of.h * wc_GAMMA);
    }
    factorise(nx, s->W, s->exchange);
}

void wc_rodas_stage(wc_rodas *s, int i) {
    int nx = s->of.k->states;
    double *U = s->U + i * nx, before[WC_MAX_STATES] = {0};
    memcpy(s->xs, s->of.x, sizeof(double) * (size_t)nx);
    wc_add_stages(nx, wc_A[i], i, s->U, s->xs);
    wc_add_stages(nx, wc_C[i], i, s->U, before);
    for (int q = 0; q < s->of.k->inputs; q++) s->ws[q] = s->of.w0[q] + wc_ALPHA[i] * (s->of.w1[q] - s->of.w0[q]);
    const double *arg[] = {s->xs, s->ws, s->of.p};
    double *res[] = {U};
    s->of.g->motion(arg, res, 0, 0, 0);
    for (int r = 0; r < nx; r++) U[r] += s->of.mass[r] * before[r] / s->of.h + wc_GAMMA_I[i] * s->ramp[r];
    solve_one(s, U);
}

void wc_rodas_end(const wc_rodas *s, double *x1, double *error) {
    int nx = s->of.k->states, last = WC_STAGES - 1;
    for (int r = 0; r < nx; r++) {
        error[r] = s->U[last * nx + r];
        x1[r] = s->xs[r] + error[r]; /* stiffly accurate: the last stage is taken at x1 but for its own U */
    }
}

void wc_rodas_step(wc_rodas_given of, double **result) {
    wc_rodas s;
    int nx = of.k->states, last = WC_STAGES - 1;
    size_t size = sizeof(double) * (size_t)nx;
    wc_rodas_begin(&s, of);
    for (int i = 0; i < WC_STAGES; i++) wc_rodas_stage(&s, i);
    wc_rodas_end(&s, result[0], result[1]);
    memset(result[2], 0, size);
    memset(result[3], 0, size);
    wc_add_stages(nx, wc_DENSE_2, last, s.U, result[2]);
    wc_add_stages(nx, wc_DENSE_3, last, s.U, result[3]);
}
