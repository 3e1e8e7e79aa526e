#include "tangent.h"

#include "advance.c" /* for `go`, which tells of each step it accepts */

#define STAGES 6

typedef struct {
    const wc_kernel *k;
    const wc_tangent *g;
    const wc_derivatives *out;
    const double *p;
    int nx, m, span; /* states, directions carried, and columns of `slopes` */
    double length;   /* of the interval between samples */
    double *D;       /* nx x m: [x(i) | pushes at i | pushes at i+1 | parameters] -> x now */
    double *dU;      /* STAGES x nx x m */
    double *at, *dM;
    double *slopes, *first, *bend; /* nx x span: states, pushes and, where any is asked for, all columns */
    double *curvature;
    double mass[WC_MAX_STATES];
} carrier;

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
        for (int r = c + 1; r < n; r++) {
            double f = W[r * n + c] /= W[c * n + c];
            if (f == 0) continue;
            for (int j = c + 1; j < n; j++) W[r * n + j] -= f * W[c * n + j];
        }
    }
}

static void add_row(int m, double factor, const double *restrict from, double *restrict to) {
    if (factor == 0) return;
    for (int c = 0; c < m; c++) to[c] += factor * from[c];
}

/* All m right sides at once; rows of `right` are contiguous. */
static void solve(int n, int m, const double *W, const int *exchange, double *right) {
    for (int c = 0; c < n; c++) { /* L was exchanged whole, so all exchanges come first */
        for (int j = 0; exchange[c] != c && j < m; j++) {
            double kept = right[c * m + j];
            right[c * m + j] = right[exchange[c] * m + j];
            right[exchange[c] * m + j] = kept;
        }
    }
    for (int c = 0; c < n; c++) {
        for (int r = c + 1; r < n; r++) add_row(m, -W[r * n + c], right + c * m, right + r * m);
    }
    for (int c = n - 1; c >= 0; c--) {
        double inverse = 1 / W[c * n + c];
        for (int j = 0; j < m; j++) right[c * m + j] *= inverse;
        for (int r = 0; r < c; r++) add_row(m, -W[r * n + c], right + c * m, right + r * m);
    }
}

static void call(wc_function f, const double *a, const double *b, const double *c, double *result) {
    const double *arg[] = {a, b, c};
    double *res[] = {result};
    f(arg, res, 0, 0, 0);
}

/* Σ a_j U_j over earlier stages, for values (m = 1) or directions. */
static void add_stages(int rows, const double *a, int stages, const double *U, double *to) {
    for (int j = 0; j < stages; j++) add_row(rows, a[j], U + (long)j * rows, to);
}

/* Right side of stage i in all directions. */
static void stage_right(carrier *c, int i, double h, const double *V, const double *part,
                        const double *slopes, double *right) {
    int nx = c->nx, m = c->m, span = c->span;
    const double *first = c->first, *bend = c->bend;
    const double *D = c->D;
    for (int r = 0; r < nx; r++) {
        double *row = right + r * m;
        memset(row, 0, sizeof(double) * (size_t)m);
        for (int j = 0; j < i; j++) add_row(m, c->mass[r] * wc_C[i][j] / h, c->dU + ((long)j * nx + r) * m, row);
        for (int k = 0; k < nx; k++) {
            add_row(m, slopes[r * span + k], c->at + k * m, row);
            add_row(m, bend[r * span + k], D + k * m, row);
        }
        for (int q = 0; q < WC_PUSHES; q++) {
            double F = slopes[r * span + nx + q], B = bend[r * span + nx + q], F0 = first[r * span + nx + q];
            for (int side = 0; side < 2; side++) { /* the push at the sample before, at the sample after */
                double wa = side ? part[0] : 1 - part[0], wb = side ? part[1] : 1 - part[1];
                row[nx + side * WC_PUSHES + q] +=
                    F * (wa + wc_ALPHA[i] * (wb - wa)) + B * wa + wc_GAMMA_I[i] * F0 * (wb - wa);
            }
        }
        for (int a = 0; c->out->forced && a < c->out->active; a++) {
            int column = c->out->which[a], at = r * span + nx + WC_PUSHES + column;
            row[nx + 2 * WC_PUSHES + a] += slopes[at] + bend[at] + c->dM[r * c->g->columns + column] * V[r];
        }
    }
}

static void carry(void *context, const double *x, const double *wa, const double *wb, double done, double h) {
    carrier *c = context;
    int nx = c->nx, m = c->m, exchange[WC_MAX_STATES];
    double U[STAGES * WC_MAX_STATES], W[WC_MAX_STATES * WC_MAX_STATES], V[WC_MAX_STATES];
    double xs[WC_MAX_STATES], ws[WC_MAX_INPUTS], dw[WC_MAX_INPUTS];
    const double *arg[] = {x, wa, wb, &h, c->p};
    double *res[] = {U, W};
    double part[2] = {done / c->length, (done + h) / c->length};
    wc_function curved = c->out->forced ? c->g->curvature_all : c->g->curvature;
    wc_function sloped = c->out->forced ? c->g->slopes_all : c->g->slopes;
    wc_function bent = c->out->forced ? c->g->bend_all : c->g->bend;
    c->g->stages(arg, res, 0, 0, 0);
    factorise(nx, W, exchange);
    call(curved, x, wa, c->p, c->curvature);
    for (int i = 0; i < STAGES; i++) {
        double *dU = c->dU + (long)i * nx * m, *slopes = i ? c->slopes : c->first;
        memcpy(xs, x, sizeof(double) * (size_t)nx);
        memset(V, 0, sizeof V);
        add_stages(nx, wc_A[i], i, U, xs);
        add_stages(nx, wc_C[i], i, U, V);
        for (int r = 0; r < nx; r++) V[r] = (V[r] - U[i * nx + r] / wc_GAMMA) / h;
        for (int q = 0; q < c->k->inputs; q++) {
            ws[q] = wa[q] + wc_ALPHA[i] * (wb[q] - wa[q]);
            dw[q] = wc_GAMMA_I[i] * (wb[q] - wa[q]);
        }
        call(sloped, xs, ws, c->p, slopes);
        call(bent, c->curvature, U + i * nx, dw, c->bend);
        memcpy(c->at, c->D, sizeof(double) * (size_t)(nx * m));
        add_stages(nx * m, wc_A[i], i, c->dU, c->at);
        stage_right(c, i, h, V, part, slopes, dU);
        solve(nx, m, W, exchange, dU);
    }
    add_stages(nx * m, wc_A[STAGES - 1], STAGES - 1, c->dU, c->D);
    add_row(nx * m, 1, c->dU + (long)(STAGES - 1) * nx * m, c->D);
}

/* Takes what was carried over one interval, and makes ready for the next. */
static void hand_over(carrier *c, long i) {
    int nx = c->nx, m = c->m;
    const wc_derivatives *out = c->out;
    for (int r = 0; r < nx; r++) {
        double *row = c->D + r * m;
        memcpy(out->transition + (i * nx + r) * nx, row, sizeof(double) * (size_t)nx);
        memcpy(out->push_before + (i * nx + r) * WC_PUSHES, row + nx, sizeof(double) * WC_PUSHES);
        memcpy(out->push_after + (i * nx + r) * WC_PUSHES, row + nx + WC_PUSHES, sizeof(double) * WC_PUSHES);
        memset(row, 0, sizeof(double) * (size_t)(nx + 2 * WC_PUSHES));
        row[r] = 1;
    }
}

static void read_out(carrier *c, long i, const double *x, const double *w, double *readout) {
    int nx = c->nx, ns = c->g->sensors, span = nx + WC_PUSHES + c->g->columns, active = c->out->active;
    call(c->g->readout, x, w, c->p, readout);
    for (int s = 0; s < ns; s++) {
        const double *row = readout + s * span;
        double *to = c->out->by_parameter + (i * ns + s) * active;
        memcpy(c->out->by_state + (i * ns + s) * nx, row, sizeof(double) * (size_t)nx);
        memcpy(c->out->by_push + (i * ns + s) * WC_PUSHES, row + nx, sizeof(double) * WC_PUSHES);
        for (int a = 0; a < active; a++) to[a] = row[nx + WC_PUSHES + c->out->which[a]];
        for (int r = 0; r < nx; r++) add_row(active, row[r], c->D + r * c->m + nx + 2 * WC_PUSHES, to);
    }
}

long wc_tangent_work(const wc_kernel *k, const wc_tangent *g, int active) {
    long nx = k->states, m = nx + 2 * WC_PUSHES + active, motion = nx + WC_PUSHES, nc = g->columns;
    return (STAGES + 2) * nx * m + 3 * nx * (motion + nc) + nx * nc + g->curvatures + g->sensors * (motion + nc);
}

wc_status wc_tangent_run(const wc_kernel *k, const wc_tangent *g, const double *p, double tolerance, long n,
                         const double *t, const double *w, double *x, double *y, const wc_derivatives *out,
                         double *work, long *reached) {
    int nx = k->states, nw = k->inputs, m = nx + 2 * WC_PUSHES + out->active;
    int widest = nx + WC_PUSHES + g->columns, span = out->forced ? widest : nx + WC_PUSHES;
    carrier c = {.k = k, .g = g, .out = out, .p = p, .nx = nx, .m = m, .span = span};
    c.D = work;
    c.dU = c.D + nx * m;
    c.at = c.dU + STAGES * nx * m;
    c.slopes = c.at + nx * m;
    c.first = c.slopes + nx * widest;
    c.bend = c.first + nx * widest;
    c.dM = c.bend + nx * widest;
    c.curvature = c.dM + nx * g->columns;
    double *readout = c.curvature + g->curvatures, now[WC_MAX_STATES], h = n > 1 ? t[1] - t[0] : 0;
    *reached = 0;
    wc_status status = wc_start(k, p, w, x);
    if (status != WC_OK) return status;
    const double *mass_arg[] = {p};
    double *mass_res[] = {c.mass, c.dM};
    g->masses(mass_arg, mass_res, 0, 0, 0);
    double *begin = c.slopes; /* free until the first step */
    call(g->begin, x, w, p, begin);
    memset(c.D, 0, sizeof(double) * (size_t)(nx * m));
    for (int r = 0; r < nx; r++) {
        c.D[r * m + r] = 1;
        for (int a = 0; a < out->active; a++)
            c.D[r * m + nx + 2 * WC_PUSHES + a] = out->start[r * out->active + a] =
                begin[r * g->columns + out->which[a]];
    }
    memcpy(now, x, sizeof(double) * (size_t)nx);
    for (long i = 0;; i++) {
        wc_output(k, p, w + i * nw, now, y + i * k->outputs);
        read_out(&c, i, now, w + i * nw, readout);
        *reached = i + 1;
        if (i + 1 == n) return WC_OK;
        stretch s = {.t0 = t[i], .length = t[i + 1] - t[i], .w0 = w + i * nw, .w1 = w + (i + 1) * nw,
                     .accepted = carry, .context = &c};
        c.length = s.length;
        status = go(k, p, tolerance, &s, now, &h, 0);
        if (status != WC_OK) return status;
        hand_over(&c, i);
        memcpy(x + (i + 1) * nx, now, sizeof(double) * (size_t)nx);
    }
}
