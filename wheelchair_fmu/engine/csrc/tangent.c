#include "advance.c" /* for `go`, which tells of each step it accepts */
#include "rodas.h"

#define STEPWISE 1e-6 /* of a stage: how far a derivative is taken by difference */

typedef struct {
    const wc_kernel *k;
    const wc_tangent *g;
    const wc_derivatives *out;
    const double *p;
    int nx, m, span; /* states, directions carried through an interval, columns of `slopes` */
    double length;   /* of the interval between samples */
    double *D;       /* nx x m: [x(i) | pushes at i | pushes at i+1 | parameters, where forced] -> x now */
    double *through; /* nx x active: x(i) by the parameters */
    double *next;
    double *dU;      /* WC_STAGES x nx x m */
    double *at, *dM, *moved; /* nx x m, nx x columns, parameters */
    double *slopes, *bend; /* nx x span: states, pushes and, where any is asked for, all columns */
    double *curvature;     /* of the step, where the model brings it */
    wc_function sloped, curved, bent;
    double mass[WC_MAX_STATES];
} carrier;

static void call(wc_function f, const double *a, const double *b, const double *c, double *result) {
    const double *arg[] = {a, b, c};
    double *res[] = {result};
    f(arg, res, 0, 0, 0);
}

/* Right side of stage i in all directions. */
static void stage_right(carrier *c, int i, double h, const double *V, const double *part,
                        const double *slopes, const double *first, double *right) {
    int nx = c->nx, m = c->m, span = c->span, motion = nx + WC_PUSHES;
    const double *bend = c->bend;
    const double *D = c->D;
    for (int r = 0; r < nx; r++) {
        double *row = right + r * m;
        memset(row, 0, sizeof(double) * (size_t)m);
        for (int j = 0; j < i; j++) wc_add_row(m, c->mass[r] * wc_C[i][j] / h, c->dU + ((long)j * nx + r) * m, row);
        for (int k = 0; k < nx; k++) {
            wc_add_row(m, slopes[r * span + k], c->at + k * m, row);
            wc_add_row(m, bend[r * span + k], D + k * m, row);
        }
        for (int q = 0; q < WC_PUSHES; q++) {
            double F = slopes[r * span + nx + q], B = bend[r * span + nx + q], F0 = first[r * motion + nx + q];
            for (int side = 0; side < 2; side++) { /* the push at the sample before, at the sample after */
                double wa = side ? part[0] : 1 - part[0], wb = side ? part[1] : 1 - part[1];
                row[nx + side * WC_PUSHES + q] +=
                    F * (wa + wc_ALPHA[i] * (wb - wa)) + B * wa + wc_GAMMA_I[i] * F0 * (wb - wa);
            }
        }
        for (int a = 0; c->out->forced && a < c->out->active; a++) {
            int column = c->out->which[a], at = r * span + motion + column;
            row[nx + 2 * WC_PUSHES + a] += slopes[at] + bend[at] + c->dM[r * c->g->columns + column] * V[r];
        }
    }
}

/* d[J U + F_w dw] by states and pushes at the step's beginning, where the model does not bring it. */
static void bend_by_difference(carrier *c, const wc_rodas *s, const double *U, const double *dw) {
    int nx = c->nx, size = nx * (nx + WC_PUSHES);
    double xs[WC_MAX_STATES], ws[WC_MAX_INPUTS];
    for (int r = 0; r < nx; r++) xs[r] = s->of.x[r] + STEPWISE * U[r];
    for (int q = 0; q < c->k->inputs; q++) ws[q] = s->of.w0[q] + STEPWISE * dw[q];
    call(c->g->slopes, xs, ws, c->p, c->bend);
    for (int e = 0; e < size; e++) c->bend[e] = (c->bend[e] - s->first[e]) / STEPWISE;
}

/* The derivatives of stage i's right side: slopes where it is taken, and how J U + F_w dw moves. */
static const double *stage_slopes(carrier *c, const wc_rodas *s, int i) {
    const double *U = s->U + i * c->nx;
    double dw[WC_MAX_INPUTS];
    for (int q = 0; q < c->k->inputs; q++) dw[q] = wc_GAMMA_I[i] * (s->of.w1[q] - s->of.w0[q]);
    if (c->bent) call(c->bent, c->curvature, U, dw, c->bend);
    else bend_by_difference(c, s, U, dw);
    if (i == 0 && !c->out->forced) return s->first;
    call(c->sloped, s->xs, s->ws, c->p, c->slopes);
    return c->slopes;
}

static void carry(void *context, const double *x, const double *wa, const double *wb, double done, double h) {
    carrier *c = context;
    int nx = c->nx, m = c->m;
    wc_rodas s;
    double V[WC_MAX_STATES], part[2] = {done / c->length, (done + h) / c->length};
    wc_rodas_begin(&s, (wc_rodas_given){.k = c->k, .g = c->g, .p = c->p, .mass = c->mass, .x = x, .w0 = wa, .w1 = wb, .h = h});
    if (c->curved) call(c->curved, x, wa, c->p, c->curvature);
    for (int i = 0; i < WC_STAGES; i++) {
        double *dU = c->dU + (long)i * nx * m;
        wc_rodas_stage(&s, i);
        memset(V, 0, sizeof V);
        wc_add_stages(nx, wc_C[i], i, s.U, V);
        for (int r = 0; r < nx; r++) V[r] = (V[r] - s.U[i * nx + r] / wc_GAMMA) / h;
        const double *slopes = stage_slopes(c, &s, i);
        memcpy(c->at, c->D, sizeof(double) * (size_t)(nx * m));
        wc_add_stages(nx * m, wc_A[i], i, c->dU, c->at);
        stage_right(c, i, h, V, part, slopes, s.first, dU);
        wc_rodas_solve(&s, m, dU);
    }
    wc_add_stages(nx * m, wc_A[WC_STAGES - 1], WC_STAGES - 1, c->dU, c->D);
    wc_add_row(nx * m, 1, c->dU + (long)(WC_STAGES - 1) * nx * m, c->D);
}

static void fresh(carrier *c) {
    memset(c->D, 0, sizeof(double) * (size_t)(c->nx * c->m));
    for (int r = 0; r < c->nx; r++) c->D[r * c->m + r] = 1;
}

/* Takes what was carried over one interval, and makes ready for the next. */
static void hand_over(carrier *c, long i) {
    int nx = c->nx, m = c->m, active = c->out->active;
    const wc_derivatives *out = c->out;
    for (int r = 0; r < nx; r++) {
        double *row = c->D + r * m;
        memcpy(out->transition + (i * nx + r) * nx, row, sizeof(double) * (size_t)nx);
        memcpy(out->push_before + (i * nx + r) * WC_PUSHES, row + nx, sizeof(double) * WC_PUSHES);
        memcpy(out->push_after + (i * nx + r) * WC_PUSHES, row + nx + WC_PUSHES, sizeof(double) * WC_PUSHES);
        double *next = c->next + r * active;
        memset(next, 0, sizeof(double) * (size_t)active);
        if (out->forced) memcpy(next, row + nx + 2 * WC_PUSHES, sizeof(double) * (size_t)active);
        for (int k = 0; k < nx; k++) wc_add_row(active, row[k], c->through + k * active, next);
    }
    double *kept = c->through;
    c->through = c->next;
    c->next = kept;
    fresh(c);
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
        for (int r = 0; r < nx; r++) wc_add_row(active, row[r], c->through + r * active, to);
    }
}

/* The start by each column, where the model does not bring it. */
static wc_status begin_by_difference(const wc_kernel *k, const wc_tangent *g, const double *p, const double *w,
                                     double *moved, double *begin) {
    double x[2][WC_MAX_STATES];
    memcpy(moved, p, sizeof(double) * (size_t)k->parameters);
    for (int c = 0; c < g->columns; c++) {
        double at = p[g->places[c]], by = STEPWISE * (1 + fabs(at));
        for (int side = 0; side < 2; side++) {
            moved[g->places[c]] = at + (side ? by : -by);
            wc_status status = wc_start(k, moved, w, x[side]);
            if (status != WC_OK) return status;
        }
        moved[g->places[c]] = at;
        for (int r = 0; r < k->states; r++) begin[r * g->columns + c] = (x[1][r] - x[0][r]) / (2 * by);
    }
    return WC_OK;
}

long wc_tangent_work(const wc_kernel *k, const wc_tangent *g, int active) {
    long nx = k->states, m = nx + 2 * WC_PUSHES + active /* at most */, nc = g->columns, span = nx + WC_PUSHES + nc;
    return (WC_STAGES + 2) * nx * m + 2 * nx * span + nx * nc + g->curvatures + k->parameters + 2 * nx * active +
           g->sensors * span;
}

wc_status wc_tangent_run(const wc_kernel *k, const wc_tangent *g, const double *p, double tolerance, long n,
                         const double *t, const double *w, double *x, double *y, const wc_derivatives *out,
                         double *work, long *reached) {
    int nx = k->states, nw = k->inputs, forced = out->forced, widest = nx + WC_PUSHES + g->columns;
    int m = nx + 2 * WC_PUSHES + (forced ? out->active : 0), span = forced ? widest : nx + WC_PUSHES;
    carrier c = {.k = k, .g = g, .out = out, .p = p, .nx = nx, .m = m, .span = span,
                 .sloped = forced ? g->slopes_all : g->slopes,
                 .curved = forced ? g->curvature_all : g->curvature,
                 .bent = forced ? g->bend_all : g->bend};
    c.D = work;
    c.dU = c.D + nx * m;
    c.at = c.dU + WC_STAGES * nx * m;
    c.slopes = c.at + nx * m;
    c.bend = c.slopes + nx * widest;
    c.dM = c.bend + nx * widest;
    c.curvature = c.dM + nx * g->columns;
    c.moved = c.curvature + g->curvatures;
    c.through = c.moved + k->parameters;
    c.next = c.through + nx * out->active;
    double *readout = c.next + nx * out->active, now[WC_MAX_STATES], h = n > 1 ? t[1] - t[0] : 0;
    *reached = 0;
    wc_status status = wc_start(k, p, w, x);
    if (status != WC_OK) return status;
    const double *mass_arg[] = {p};
    double *mass_res[] = {c.mass, c.dM};
    g->masses(mass_arg, mass_res, 0, 0, 0);
    double *begin = c.slopes; /* free until the first step */
    if (g->begin) call(g->begin, x, w, p, begin);
    else status = begin_by_difference(k, g, p, w, c.moved, begin);
    if (status != WC_OK) return status;
    fresh(&c);
    for (int r = 0; r < nx; r++)
        for (int a = 0; a < out->active; a++)
            c.through[r * out->active + a] = out->start[r * out->active + a] = begin[r * g->columns + out->which[a]];
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
