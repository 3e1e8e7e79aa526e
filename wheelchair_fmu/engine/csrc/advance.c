#include "advance.h"

#include <math.h>
#include <string.h>

#define WC_SHORTEST 1e-11 /* s; a step shorter than this means the model cannot go on */
#define WC_SNAP 1e-6      /* of the grid: communication points this near a grid point are on it */
#define WC_NEWTON 25
#define WC_NOTHING 1e-35  /* a state smaller than this is zero: at rest all decay, and its eighth power must not underflow */

/* A stretch of time with linear inputs, and the rows to fill on the way. */
typedef struct {
    double t0, length;
    const double *w0, *w1;
    const double *at; /* times of rows wanted inside, ascending */
    long wanted;
    double *rows;
    /* takes steps in the place of the kernel's, which tells less of them: x1 and its error */
    void (*taken)(void *context, const double *x, const double *wa, const double *wb, double h, double *x1, double *e);
    /* told of each of these that is accepted, from `done` on */
    void (*accepted)(void *context, const double *x, const double *wa, double done, double h);
    void *context;
    int unseen; /* nobody looks at the states before the end */
} stretch;

/* Exactly what both are where they are equal: what rests goes on resting. */
static double shape_of(double s, double a, double b) { return a == b ? a : (1 - s) * a + s * b; }

/* Of all rows, or where their masses are given, of those that are integrated. */
static double error_norm(const wc_kernel *k, double tolerance, const double *mass, const double *x, const double *x1,
                         const double *e) {
    double worst = 0;
    for (int i = 0; i < k->states; i++) {
        if (mass && mass[i] == 0) continue;
        double size = fabs(x[i]) > fabs(x1[i]) ? fabs(x[i]) : fabs(x1[i]);
        double here = fabs(e[i]) / (tolerance * (k->nominal[i] + size));
        if (isnan(here)) return here;
        if (here > worst) worst = here;
    }
    return worst;
}

/* Rows inside the step [done, done + h], by the method's own interpolation. */
static void fill_rows(const wc_kernel *k, stretch *s, double done, double h, const double *x, const double *x1,
                      const double *d2, const double *d3) {
    while (s->wanted > 0 && *s->at - s->t0 <= done + h) {
        double f = (*s->at - s->t0 - done) / h;
        for (int i = 0; i < k->states; i++) {
            s->rows[i] = shape_of(f, x[i], x1[i] + (1 - f) * (d2[i] + f * d3[i]));
        }
        s->rows += k->states;
        s->at++;
        s->wanted--;
    }
}

/* Do the inputs rest that most runs leave at rest? */
static int rests(const wc_kernel *k, const double *w) {
    for (int i = 0; i < k->seldom; i++)
        if (w[k->seldom_inputs[i]] != k->resting[i]) return 0;
    return 1;
}

static int without_effects(const wc_kernel *k, const double *p) {
    for (int i = 0; i < k->switches; i++)
        if (p[k->switch_parameters[i]] != 0) return 0;
    return 1;
}

/* What takes a step while the inputs go from w0 to w1. */
static wc_function step_between(const wc_kernel *k, const double *p, const double *w0, const double *w1) {
    if ((!k->plain && !k->bare) || !rests(k, w0) || !rests(k, w1)) return k->step;
    if (k->bare && without_effects(k, p)) return k->bare;
    return k->plain ? k->plain : k->step;
}

/* Goes the whole stretch in steps of the size the error allows; *h is the first to try and the next. */
static wc_status go(const wc_kernel *k, const double *p, double tolerance, stretch *s, double *x, double *h,
                    long *steps) {
    double wa[WC_MAX_INPUTS], wb[WC_MAX_INPUTS];
    double x1[WC_MAX_STATES], e[WC_MAX_STATES], d2[WC_MAX_STATES], d3[WC_MAX_STATES], masses[WC_MAX_STATES];
    const double *mass = 0;
    wc_function step = step_between(k, p, s->w0, s->w1);
    double done = 0;
    double tries = 0, most = wc_most_tries(s->length);
    while (done < s->length) {
        if (++tries > most) return WC_STEP_TOO_SMALL;
        double left = s->length - done;
        double now = *h < left * (1 - 1e-9) ? *h : left;
        double fa = done / s->length, fb = now == left ? 1 : (done + now) / s->length;
        for (int i = 0; i < k->inputs; i++) {
            wa[i] = shape_of(fa, s->w0[i], s->w1[i]);
            wb[i] = shape_of(fb, s->w0[i], s->w1[i]);
        }
        const double *arg[] = {x, wa, wb, &now, p};
        double *res[] = {x1, e, d2, d3};
        if (s->taken) s->taken(s->context, x, wa, wb, now, x1, e);
        else step(arg, res, 0, 0, 0);
        double error = error_norm(k, tolerance, mass, x, x1, e);
        if (!(error <= 1) && s->unseen && !mass) {
            /* No step carries the error of an algebraic row on, so it is enough to put these rows right at the end. Where
             * a force turns round, as when a wheel stops, they jump, and to follow them takes many times the steps. */
            const double *of[] = {p};
            double *to[] = {masses};
            k->mass(of, to, 0, 0, 0);
            mass = masses;
            error = error_norm(k, tolerance, mass, x, x1, e);
        }
        double factor = error == 0 ? 6 : 0.9 / sqrt(sqrt(error));
        if (error <= 1) {
            if (s->taken) s->accepted(s->context, x, wa, done, now);
            else fill_rows(k, s, done, now, x, x1, d2, d3);
            for (int i = 0; i < k->states; i++) x[i] = fabs(x1[i]) < WC_NOTHING ? 0 : x1[i];
            done = now == left ? s->length : done + now;
            if (steps) ++*steps;
            factor = factor > 6 ? 6 : factor < 0.2 ? 0.2 : factor;
            if (now == *h || factor < 1) *h = now * factor;
        } else {
            factor = factor > 0.1 ? factor : 0.1; /* also where error is NaN */
            *h = now * factor;
            if (*h < WC_SHORTEST) return isfinite(error) ? WC_STEP_TOO_SMALL : WC_NOT_FINITE;
        }
    }
    return mass ? wc_project(k, p, wb, x) : WC_OK;
}

wc_status wc_start(const wc_kernel *k, const double *p, const double *w, double *x) {
    const double *arg[] = {p, w};
    double *res[] = {x};
    k->start(arg, res, 0, 0, 0);
    return wc_project(k, p, w, x);
}

wc_status wc_project(const wc_kernel *k, const double *p, const double *w, double *x) {
    double next[WC_MAX_STATES];
    for (int round = 0; round < WC_NEWTON; round++) {
        double change = 0;
        const double *arg[] = {x, w, p};
        double *res[] = {next};
        k->project(arg, res, 0, 0, 0);
        for (int i = 0; i < k->states; i++) {
            double here = fabs(next[i] - x[i]) / (k->nominal[i] + fabs(next[i]));
            if (!isfinite(here)) return WC_NOT_FINITE;
            if (here > change) change = here;
        }
        memcpy(x, next, sizeof(double) * (size_t)k->states);
        if (change < 1e-14) return WC_OK;
        if (round > 4 && change < 1e-10) return WC_OK; /* rounding goes on for ever in the last digits */
    }
    return WC_NOT_CONSISTENT;
}

static wc_status advance_on_grid(const wc_kernel *k, const double *p, wc_accuracy accuracy, double t0, double t1,
                                 const double *w0, const double *w1, double *x, long *steps) {
    double grid = accuracy.grid, wa[WC_MAX_INPUTS], wb[WC_MAX_INPUTS];
    double cell = floor(t0 / grid + WC_SNAP);
    double from = fabs(t0 / grid - cell) < WC_SNAP ? 0 : t0 - cell * grid; /* into the cell */
    double last = t1 / grid;
    for (;; cell++, from = 0) {
        int whole = cell + 1 <= last + WC_SNAP;
        double to = whole ? grid : t1 - cell * grid;
        int final = cell + 1 >= last - WC_SNAP;
        double fa = (cell * grid + from - t0) / (t1 - t0), fb = final ? 1 : (cell * grid + to - t0) / (t1 - t0);
        for (int i = 0; i < k->inputs; i++) {
            wa[i] = shape_of(fa, w0[i], w1[i]);
            wb[i] = shape_of(fb, w0[i], w1[i]);
        }
        stretch s = {.length = to - from, .w0 = wa, .w1 = wb, .unseen = 1};
        double h = s.length;
        wc_status status = go(k, p, accuracy.tolerance, &s, x, &h, steps);
        if (status != WC_OK || final) return status;
    }
}

wc_status wc_advance(const wc_kernel *k, const double *p, wc_accuracy accuracy, double t0, double t1,
                     const double *w0, const double *w1, double *x, long *steps) {
    double kept[WC_MAX_STATES];
    memcpy(kept, x, sizeof(double) * (size_t)k->states);
    wc_status status;
    if (accuracy.grid > 0) {
        status = advance_on_grid(k, p, accuracy, t0, t1, w0, w1, x, steps);
    } else {
        stretch s = {.t0 = t0, .length = t1 - t0, .w0 = w0, .w1 = w1};
        double h = s.length;
        status = go(k, p, accuracy.tolerance, &s, x, &h, steps);
    }
    if (status != WC_OK) memcpy(x, kept, sizeof(double) * (size_t)k->states);
    return status;
}

void wc_output(const wc_kernel *k, const double *p, const double *w, const double *x, double *y) {
    const double *arg[] = {x, w, p};
    double *res[] = {y};
    int bare = k->bare_output && rests(k, w) && without_effects(k, p);
    (bare ? k->bare_output : k->output)(arg, res, 0, 0, 0);
}

/* The last row up to which the inputs go on in the straight line on which they leave row i. */
static long straight_until(const wc_kernel *k, long n, long i, const double *t, const double *w) {
    int m = k->inputs;
    long j = i + 1;
    for (; j + 1 < n; j++) {
        double f = (t[j + 1] - t[i]) / (t[i + 1] - t[i]);
        for (int c = 0; c < m; c++) {
            double first = w[i * m + c], there = w[(j + 1) * m + c];
            double off = fabs(shape_of(f, first, w[(i + 1) * m + c]) - there);
            if (!(off <= 1e-13 * (fabs(first) + fabs(there)))) return j; /* also where it is NaN */
        }
    }
    return j;
}

static wc_status run_held(const wc_kernel *k, const double *p, wc_accuracy accuracy, long n, const double *t,
                          const double *w, double *x, double *y, long *reached, long *steps) {
    int nx = k->states, nw = k->inputs;
    for (long i = 0; i + 1 < n; i++, *reached = i + 1) {
        double *here = x + i * nx, *next = here + nx;
        memcpy(next, here, sizeof(double) * (size_t)nx);
        wc_status status = wc_project(k, p, w + i * nw, next);
        if (status == WC_OK)
            status = wc_advance(k, p, accuracy, t[i] - t[0], t[i + 1] - t[0], w + i * nw, w + i * nw, next, steps);
        if (status != WC_OK) return status;
        wc_output(k, p, w + i * nw, next, y + (i + 1) * k->outputs);
    }
    return WC_OK;
}

static wc_status run_linear(const wc_kernel *k, const double *p, wc_accuracy accuracy, long n, const double *t,
                            const double *w, double *x, double *y, long *reached, long *steps) {
    int nx = k->states, nw = k->inputs;
    double now[WC_MAX_STATES], h = n > 1 ? t[1] - t[0] : 0;
    memcpy(now, x, sizeof(double) * (size_t)nx);
    for (long i = 0; i + 1 < n;) {
        long j = accuracy.grid > 0 ? i + 1 : straight_until(k, n, i, t, w);
        const double *w0 = w + i * nw, *w1 = w + j * nw;
        wc_status status;
        if (accuracy.grid > 0) {
            status = wc_advance(k, p, accuracy, t[i] - t[0], t[j] - t[0], w0, w1, now, steps);
        } else {
            stretch s = {.t0 = t[i], .length = t[j] - t[i], .w0 = w0, .w1 = w1,
                         .at = t + i + 1, .wanted = j - i - 1, .rows = x + (i + 1) * nx};
            status = go(k, p, accuracy.tolerance, &s, now, &h, steps);
        }
        if (status != WC_OK) return status;
        memcpy(x + j * nx, now, sizeof(double) * (size_t)nx);
        for (long r = i + 1; r <= j; r++) wc_output(k, p, w + r * nw, x + r * nx, y + r * k->outputs);
        i = j;
        *reached = i + 1;
    }
    return WC_OK;
}

wc_status wc_run(const wc_kernel *k, const double *p, wc_accuracy accuracy, long n, const double *t, const double *w,
                 int hold, double *x, double *y, long *reached, long *steps) {
    *reached = 0;
    wc_status status = wc_project(k, p, w, x);
    if (status != WC_OK) return status;
    wc_output(k, p, w, x, y);
    *reached = 1;
    return (hold ? run_held : run_linear)(k, p, accuracy, n, t, w, x, y, reached, steps);
}
