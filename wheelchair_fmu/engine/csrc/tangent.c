#include "advance.c" /* for `go`, which tells of each step it accepts */
#include "rodas.h"

#include <stdint.h>

#define STEPWISE 1e-6 /* of a stage: how far a derivative is taken by difference */
#define WHOLE 8       /* numbers in the longest vectors */
#define LANE 4        /* rows of numbers by states now are padded to whole lanes, which compilers make vectors of */

/* Where the equations move with a parameter: in this row, by this column, the so-manieth of those asked for. */
typedef struct {
    int row, column, place;
} touch;

/* What is by states now stands in rows of `stride`, one row for each that it is derived by. */
typedef struct {
    const wc_kernel *k;
    const wc_tangent *g;
    const wc_derivatives *out;
    const double *p;
    int nx, stride, m, span; /* states, padded; rows of D; columns of `slopes` */
    double length;   /* of the interval between samples */
    double *D;       /* m rows: x now by [x(i) | pushes at i | pushes at i+1 | parameters, where forced] */
    double *step;    /* m rows: the step's end by its start, by the pushes at its start and its end, by parameters */
    double *spare;   /* m rows */
    double *G, *P;   /* WC_STAGES x nx rows: the step's end by a stage's right side, and by where the stage is taken */
    double *through; /* nx x active: x(i) by the parameters */
    double *next;
    double *dM, *moved; /* nx x columns, parameters */
    int side;           /* stages that are evaluated in one call: a number of each of them stands beside that of the next */
    double *slopes;     /* of each stage nx x span: states, pushes and, where any is asked for, all columns */
    double *bend;       /* the same */
    double *xs, *ws, *along, *dw; /* where stages are taken, and along what they bend: nx and inputs of each */
    double *prepared;   /* what bends of a step have in common, where the model brings it */
    touch *touched;
    int touches;
    wc_function sloped, prepare, bent;
    double mass[WC_MAX_STATES];
    wc_rodas s;         /* the latest step */
} carrier;

static void call(wc_function f, const double *a, const double *b, const double *c, double *result) {
    const double *arg[] = {a, b, c};
    double *res[] = {result};
    f(arg, res, 0, 0, 0);
}

/* to += factor from, whole lanes. */
static inline void add(int n, double factor, const double *restrict from, double *restrict to) {
    if (factor == 0) return;
    for (int c = 0; c < n; c += LANE)
        for (int e = 0; e < LANE; e++) to[c + e] += factor * from[c + e];
}

/* Where number `at` of stage i stands among `size` numbers of each stage. */
static inline long of_stage(const carrier *c, int i, int at, int size) {
    return ((long)(i / c->side) * size + at) * c->side + i % c->side;
}

/* Puts `size` numbers of stage i where they belong; the last stage also where there would be more. */
static void place(const carrier *c, int i, int size, const double *from, double *to) {
    int beyond = i + 1 == WC_STAGES ? (WC_STAGES + c->side - 1) / c->side * c->side : i + 1;
    for (int j = i; j < beyond; j++)
        for (int at = 0; at < size; at++) to[of_stage(c, j, at, size)] = from[at];
}

/* G of stage i from those of the stages after it: what its U moves in them and in the end, through W. */
static void backward(carrier *c, const wc_rodas *s, int i, double h) {
    int nx = c->nx, stride = c->stride, size = nx * stride;
    double *G = c->G + i * size, *P = c->P + i * size;
    const double *slopes = c->slopes + of_stage(c, i, 0, nx * c->span);
    memset(G, 0, sizeof(double) * (size_t)size);
    for (int r = 0; r < nx; r++) G[r * stride + r] = i + 1 == WC_STAGES ? 1 : wc_A[WC_STAGES - 1][i];
    for (int j = i + 1; j < WC_STAGES; j++) {
        add(size, wc_A[j][i], c->P + j * size, G);
        for (int r = 0; r < nx; r++) add(stride, c->mass[r] * wc_C[j][i] / h, c->G + j * size + r * stride, G + r * stride);
    }
    wc_rodas_solve_transposed(s, stride, G);
    memset(P, 0, sizeof(double) * (size_t)size);
    for (int r = 0; r < nx; r++)
        for (int k = 0; k < nx; k++) add(stride, slopes[(r * c->span + k) * c->side], G + r * stride, P + k * stride);
}

/* What stage i adds to the derivatives of the step. V is what stands beside dM. */
static void gather(carrier *c, int i, const double *V, const double *first) {
    int nx = c->nx, stride = c->stride, span = c->span, motion = nx + WC_PUSHES;
    double *by_push = c->step + nx * stride, *by_parameter = by_push + 2 * WC_PUSHES * stride;
    long begin = of_stage(c, i, 0, nx * span);
    const double *G = c->G + i * nx * stride, *F = c->slopes + begin, *B = c->bend + begin;
    add(nx * stride, 1, c->P + i * nx * stride, c->step);
    for (int r = 0; r < nx; r++) {
        for (int k = 0; k < nx; k++) add(stride, B[(r * span + k) * c->side], G + r * stride, c->step + k * stride);
        for (int q = 0; q < WC_PUSHES; q++) {
            int at = (r * span + nx + q) * c->side;
            double later = F[at] * wc_ALPHA[i] + wc_GAMMA_I[i] * first[r * motion + nx + q];
            add(stride, F[at] + B[at] - later, G + r * stride, by_push + q * stride);
            add(stride, later, G + r * stride, by_push + (WC_PUSHES + q) * stride);
        }
    }
    for (const touch *e = c->touched; e < c->touched + c->touches; e++) {
        int at = (e->row * span + motion + e->column) * c->side;
        double moved = F[at] + B[at] + c->dM[e->row * c->g->columns + e->column] * V[e->row];
        add(stride, moved, G + e->row * stride, by_parameter + e->place * stride);
    }
}

/* d[J U + F_w dw] by states and pushes at the step's beginning, where the model does not bring it. */
static void bend_by_difference(const carrier *c, const wc_rodas *s, const double *U, const double *dw, double *bend) {
    int nx = c->nx, size = nx * (nx + WC_PUSHES);
    double xs[WC_MAX_STATES], ws[WC_MAX_INPUTS];
    for (int r = 0; r < nx; r++) xs[r] = s->of.x[r] + STEPWISE * U[r];
    for (int q = 0; q < c->k->inputs; q++) ws[q] = s->of.w0[q] + STEPWISE * dw[q];
    call(c->g->slopes, xs, ws, c->p, bend);
    for (int e = 0; e < size; e++) bend[e] = (bend[e] - s->first[e]) / STEPWISE;
}

/* Slopes where each stage is taken, and how J U + F_w dw of it moves: several stages in a call. */
static void evaluate(carrier *c, const wc_rodas *s) {
    int nx = c->nx, nw = c->k->inputs, size = nx * c->span;
    for (int i = 0; i < WC_STAGES; i += c->side) {
        const double *U = c->along + i * nx, *dw = c->dw + i * nw;
        if (i == 0 && !c->out->forced) memcpy(c->slopes, s->first, sizeof(double) * (size_t)size);
        else call(c->sloped, c->xs + i * nx, c->ws + i * nw, c->p, c->slopes + i * size);
        if (c->bent) call(c->bent, c->prepared, U, dw, c->bend + i * size);
        else bend_by_difference(c, s, U, dw, c->bend + i * size);
    }
}

/* D goes on over a step from and to these parts of the interval. */
static void compose(carrier *c, double from, double to) {
    int nx = c->nx, stride = c->stride;
    const double *push[] = {c->step + nx * stride, c->step + (nx + WC_PUSHES) * stride};
    double *D = c->spare;
    memset(D, 0, sizeof(double) * (size_t)(c->m * stride));
    for (int row = 0; row < c->m; row++)
        for (int k = 0; k < nx; k++) add(stride, c->D[row * stride + k], c->step + k * stride, D + row * stride);
    for (int end = 0; end < 2; end++) { /* the step's pushes, of the sample before and the sample after */
        double part = end ? to : from;
        add(WC_PUSHES * stride, 1 - part, push[end], D + nx * stride);
        add(WC_PUSHES * stride, part, push[end], D + (nx + WC_PUSHES) * stride);
    }
    int others = nx + 2 * WC_PUSHES;
    add((c->m - others) * stride, 1, c->step + others * stride, D + others * stride);
    c->spare = c->D;
    c->D = D;
}

/* The same of a step over the whole interval, before which there was none: D is the step. */
static void take_whole(carrier *c) {
    double *kept = c->D;
    c->D = c->step;
    c->step = kept;
}

/* One step, as far as nobody knows whether it is accepted. */
static void take(void *context, const double *x, const double *wa, const double *wb, double h, double *x1, double *e) {
    carrier *c = context;
    wc_rodas *s = &c->s;
    int nx = c->nx, nw = c->k->inputs;
    wc_rodas_begin(s, (wc_rodas_given){.k = c->k, .g = c->g, .p = c->p, .mass = c->mass, .x = x, .w0 = wa, .w1 = wb, .h = h});
    for (int i = 0; i < WC_STAGES; i++) {
        double dw[WC_MAX_INPUTS];
        wc_rodas_stage(s, i);
        for (int q = 0; q < nw; q++) dw[q] = wc_GAMMA_I[i] * (wb[q] - wa[q]);
        place(c, i, nx, s->xs, c->xs);
        place(c, i, nw, s->ws, c->ws);
        place(c, i, nx, s->U + i * nx, c->along);
        place(c, i, nw, dw, c->dw);
    }
    wc_rodas_end(s, x1, e);
}

/* Derives a step that is accepted. */
static void carry(void *context, const double *x, const double *wa, double done, double h) {
    carrier *c = context;
    const wc_rodas *s = &c->s;
    int nx = c->nx;
    double V[WC_MAX_STATES];
    if (c->prepare) call(c->prepare, x, wa, c->p, c->prepared);
    evaluate(c, s);
    memset(c->step, 0, sizeof(double) * (size_t)(c->m * c->stride));
    for (int i = WC_STAGES - 1; i >= 0; i--) {
        memset(V, 0, sizeof V);
        wc_add_stages(nx, wc_C[i], i, s->U, V);
        for (int r = 0; r < nx; r++) V[r] = (V[r] - s->U[i * nx + r] / wc_GAMMA) / h;
        backward(c, s, i, h);
        gather(c, i, V, s->first);
    }
    for (int r = 0; r < nx; r++) c->step[r * c->stride + r] += 1;
    if (done == 0 && h == c->length) take_whole(c);
    else compose(c, done / c->length, (done + h) / c->length);
}

static void fresh(carrier *c) {
    memset(c->D, 0, sizeof(double) * (size_t)(c->m * c->stride));
    for (int r = 0; r < c->nx; r++) c->D[r * c->stride + r] = 1;
}

/* Takes what was carried over one interval, and makes ready for the next. */
static void hand_over(carrier *c, long i) {
    int nx = c->nx, stride = c->stride, active = c->out->active;
    const wc_derivatives *out = c->out;
    const double *before = c->D + nx * stride, *after = before + WC_PUSHES * stride, *own = after + WC_PUSHES * stride;
    for (int r = 0; r < nx; r++) {
        double *next = c->next + r * active;
        for (int k = 0; k < nx; k++) out->transition[(i * nx + r) * nx + k] = c->D[k * stride + r];
        for (int q = 0; q < WC_PUSHES; q++) {
            out->push_before[(i * nx + r) * WC_PUSHES + q] = before[q * stride + r];
            out->push_after[(i * nx + r) * WC_PUSHES + q] = after[q * stride + r];
        }
        for (int a = 0; a < active; a++) next[a] = out->forced ? own[a * stride + r] : 0;
        for (int k = 0; k < nx; k++) wc_add_row(active, c->D[k * stride + r], c->through + k * active, next);
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

/* Which places of the equations move with what is asked for. */
static int find_touched(const wc_tangent *g, const wc_derivatives *out, touch *to) {
    int n = 0;
    for (int a = 0; out->forced && a < out->active; a++)
        for (int e = 0; e < g->touches; e++)
            if (g->touched[e] % g->columns == out->which[a]) to[n++] = (touch){g->touched[e] / g->columns, out->which[a], a};
    return n;
}

/* As many stages as are evaluated, in whole calls. */
static long evaluated(int side) { return (WC_STAGES + side - 1) / side * side; }

/* The next place that is on a whole vector. */
static double *aligned(double *at) {
    uintptr_t whole = WHOLE * sizeof(double);
    return (double *)(((uintptr_t)at + whole - 1) / whole * whole);
}

static int padded(int n) { return (n + LANE - 1) / LANE * LANE; }

long wc_tangent_work(const wc_kernel *k, const wc_tangent *g, int active) {
    long nx = k->states, stride = padded(k->states), m = nx + 2 * WC_PUSHES + active /* at most */, nc = g->columns;
    long span = nx + WC_PUSHES + nc;
    return 3 * m * stride + 2 * WC_STAGES * nx * stride + 2 * evaluated(g->side) * (nx * span + nx + k->inputs) + 6 * WHOLE + nx * nc +
           g->prepared + k->parameters + 2 * nx * active + g->sensors * span + 2 * g->touches; /* a touch is smaller than two */
}

wc_status wc_tangent_run(const wc_kernel *k, const wc_tangent *g, const double *p, double tolerance, long n,
                         const double *t, const double *w, double *x, double *y, const wc_derivatives *out,
                         double *work, long *reached) {
    int nx = k->states, nw = k->inputs, forced = out->forced, widest = nx + WC_PUSHES + g->columns, stride = padded(nx);
    int m = nx + 2 * WC_PUSHES + (forced ? out->active : 0), span = forced ? widest : nx + WC_PUSHES;
    carrier c = {.k = k, .g = g, .out = out, .p = p, .nx = nx, .stride = stride, .m = m, .span = span,
                 .side = forced ? g->side : 1,
                 .sloped = forced ? g->slopes_all : g->slopes,
                 .prepare = forced ? g->prepare_all : g->prepare,
                 .bent = forced ? g->bend_all : g->bend};
    c.D = work;
    c.step = c.D + m * stride;
    c.spare = c.step + m * stride;
    c.G = c.spare + m * stride;
    c.P = c.G + WC_STAGES * nx * stride;
    long stages = evaluated(c.side);
    c.slopes = aligned(c.P + WC_STAGES * nx * stride);
    c.bend = aligned(c.slopes + stages * nx * widest);
    c.xs = aligned(c.bend + stages * nx * widest);
    c.ws = aligned(c.xs + stages * nx);
    c.along = aligned(c.ws + stages * k->inputs);
    c.dw = aligned(c.along + stages * nx);
    c.dM = c.dw + stages * k->inputs;
    c.prepared = c.dM + nx * g->columns;
    c.moved = c.prepared + g->prepared;
    c.through = c.moved + k->parameters;
    c.next = c.through + nx * out->active;
    c.touched = (touch *)(c.next + nx * out->active);
    c.touches = find_touched(g, out, c.touched);
    double *readout = c.next + nx * out->active + 2 * g->touches, now[WC_MAX_STATES], h = n > 1 ? t[1] - t[0] : 0;
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
                     .taken = take, .accepted = carry, .context = &c};
        c.length = s.length;
        status = go(k, p, tolerance, &s, now, &h, 0);
        if (status != WC_OK) return status;
        hand_over(&c, i);
        memcpy(x + (i + 1) * nx, now, sizeof(double) * (size_t)nx);
    }
}
