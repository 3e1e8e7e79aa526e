/* Many chairs through the same inputs, one in each lane of a vector: what wc_run does with linear inputs and no grid, for each.
 *
 * Lanes share an instruction and nothing else: each has its own time, its own steps and its own error test, and the next chair
 * boards as soon as one is through. So a chair's results do not depend on which chairs are beside it. */
#define WC_LOCAL static
#include "advance.c"
#include "lanes.h"

/* Generated: one step, for (x, w0, w1, h, p) → x1, error, d2, d3; and the results that are wanted, for (x, w, p), in two parts:
 * what follows from parameters alone, or where no input moves from these as well, and the rest. */
void lanes_step(const lanes **arg, lanes **res);
extern const int lanes_output_kept, lanes_still_kept;
void lanes_output_once(const lanes **arg, lanes *kept);
void lanes_output(const lanes **arg, lanes **res, const lanes *kept);
void lanes_still_once(const lanes **arg, lanes *kept);
void lanes_still(const lanes **arg, lanes **res, const lanes *kept);

/* What all chairs go through. */
typedef struct {
    const wc_kernel *k;
    double tolerance;
    long n, padded; /* rows, and as many as fill whole vectors */
    const double *t, *w;
    const long *ends;  /* row by row, up to which one the inputs go on straight */
    int moving[WC_MAX_INPUTS], movings; /* inputs that are not the same at all times */
    double *inputs;    /* movings x padded */
    double *shares;    /* padded: where in a step rows are */
    int results;
} course;

/* Who is in a lane. */
typedef struct {
    long chair;         /* below zero: nobody */
    long from, to, row; /* rows between which the inputs now go straight, and the next one to fill */
    double done, length, h, now; /* of the time between them; the step to try next, and the one that is tried */
    double tries;       /* steps that were tried there */
    double *rows;       /* states x padded */
} rider;

typedef struct {
    const course *c;
    rider riders[WC_LANES];
    lanes x[WC_MAX_STATES], w0[WC_MAX_INPUTS], w1[WC_MAX_INPUTS], wa[WC_MAX_INPUTS], wb[WC_MAX_INPUTS];
    lanes x1[WC_MAX_STATES], e[WC_MAX_STATES], d2[WC_MAX_STATES], d3[WC_MAX_STATES];
    lanes *p;
    long chairs, next; /* all of them, and the next one to board */
    const double *own; /* chairs x parameters */
    double *y;
    int *status;
    long *reached;
} carriage;

static lanes shapes_of(lanes s, lanes a, lanes b) { return lanes_choose(a == b, a, (1 - s) * a + s * b); }

/* As error_norm, lane by lane. */
static lanes error_norms(const carriage *a) {
    const wc_kernel *k = a->c->k;
    lanes worst = {0};
    masks odd = {0};
    for (int i = 0; i < k->states; i++) {
        lanes size = lanes_fmax(lanes_fabs(a->x[i]), lanes_fabs(a->x1[i]));
        lanes here = lanes_fabs(a->e[i]) / (a->c->tolerance * (k->nominal[i] + size));
        odd |= here != here;
        worst = lanes_fmax(here, worst);
    }
    return lanes_choose(odd, WC_EVEN(NAN), worst);
}

/* From this row on the inputs go another way. */
static void turn(carriage *a, int e, long row) {
    const course *c = a->c;
    rider *r = a->riders + e;
    int nw = c->k->inputs;
    r->from = row;
    r->to = c->ends[row];
    r->row = row + 1;
    r->done = 0;
    r->tries = 0;
    r->length = c->t[r->to] - c->t[row];
    for (int m = 0; m < c->movings; m++) {
        int q = c->moving[m];
        a->w0[q][e] = c->w[row * nw + q];
        a->w1[q][e] = c->w[r->to * nw + q];
    }
}

static void keep(const carriage *a, int e, long row) {
    for (int i = 0; i < a->c->k->states; i++) a->riders[e].rows[i * a->c->padded + row] = a->x[i][e];
}

/* As fill_rows, of one lane. */
static void fill(const carriage *a, int e, rider *r) {
    const course *c = a->c;
    double t0 = c->t[r->from], *shares = c->shares;
    long first = r->row;
    for (; r->row < r->to && c->t[r->row] - t0 <= r->done + r->now; r->row++)
        shares[r->row] = (c->t[r->row] - t0 - r->done) / r->now;
    for (int i = 0; i < c->k->states; i++) {
        double *to = r->rows + i * c->padded, x = a->x[i][e], x1 = a->x1[i][e], d2 = a->d2[i][e], d3 = a->d3[i][e];
        for (long row = first; row < r->row; row++) {
            double f = shares[row], there = x1 + (1 - f) * (d2 + f * d3);
            to[row] = shape_of(f, x, there);
        }
    }
}

/* Results of a whole run, several rows in one instruction. */
static void read_out(const course *c, const double *p, const double *rows, double *y) {
    int nx = c->k->states, nw = c->k->inputs, np = c->k->parameters;
    lanes x[WC_MAX_STATES], w[WC_MAX_INPUTS], each[np], result[c->results];
    for (int i = 0; i < np; i++) each[i] = WC_EVEN(p[i]);
    for (int q = 0; q < nw; q++) w[q] = WC_EVEN(c->w[q]);
    const lanes *arg[] = {x, w, each};
    lanes *res[] = {result}, kept[1 + (c->movings ? lanes_output_kept : lanes_still_kept)];
    (c->movings ? lanes_output_once : lanes_still_once)(arg, kept);
    void (*output)(const lanes **, lanes **, const lanes *) = c->movings ? lanes_output : lanes_still;
    for (long row = 0; row < c->n; row += WC_LANES) {
        long left = c->n - row;
        for (int i = 0; i < nx; i++) memcpy(x + i, rows + i * c->padded + row, sizeof(lanes));
        for (int m = 0; m < c->movings; m++) memcpy(w + c->moving[m], c->inputs + m * c->padded + row, sizeof(lanes));
        output(arg, res, kept);
        for (int i = 0; i < c->results; i++) {
            double *to = y + i * c->n + row;
            if (left >= WC_LANES) memcpy(to, result + i, sizeof(lanes));
            else memcpy(to, result + i, sizeof(double) * (size_t)left);
        }
    }
}

/* The next chair that can start takes lane e. Says whether there was one. */
static int board(carriage *a, int e) {
    const wc_kernel *k = a->c->k;
    rider *r = a->riders + e;
    double x[WC_MAX_STATES];
    r->chair = -1;
    r->now = 1; /* something that can be divided by, where nobody is left */
    for (; a->next < a->chairs && r->chair < 0; a->next++) {
        const double *p = a->own + a->next * k->parameters;
        wc_status status = wc_start(k, p, a->c->w, x);
        if (status == WC_OK) status = wc_project(k, p, a->c->w, x); /* as wc_run does */
        a->status[a->next] = status;
        if (status != WC_OK) continue;
        r->chair = a->next;
        for (int i = 0; i < k->states; i++) a->x[i][e] = x[i];
        for (int i = 0; i < k->parameters; i++) a->p[i][e] = p[i];
        keep(a, e, 0);
        r->h = a->c->t[1] - a->c->t[0];
        turn(a, e, 0);
    }
    return r->chair >= 0;
}

/* One step tried in every lane: its error, 1 being the tolerance, and by how much the next one may be longer. */
static void attempt(carriage *a, lanes *error, lanes *factor) {
    const course *c = a->c;
    lanes fa = {0}, fb = {0}, h;
    for (int e = 0; e < WC_LANES; e++) {
        rider *r = a->riders + e;
        if (r->chair >= 0) {
            double left = r->length - r->done;
            r->now = r->h < left * (1 - 1e-9) ? r->h : left;
            fa[e] = r->done / r->length;
            fb[e] = r->now == left ? 1 : (r->done + r->now) / r->length;
        }
        h[e] = r->now;
    }
    for (int m = 0; m < c->movings; m++) {
        int q = c->moving[m];
        a->wa[q] = shapes_of(fa, a->w0[q], a->w1[q]);
        a->wb[q] = shapes_of(fb, a->w0[q], a->w1[q]);
    }
    const lanes *arg[] = {a->x, a->wa, a->wb, &h, a->p};
    lanes *res[] = {a->x1, a->e, a->d2, a->d3};
    lanes_step(arg, res);
    *error = error_norms(a);
    *factor = lanes_choose(*error == 0, WC_EVEN(6.0), 0.9 / lanes_sqrt(lanes_sqrt(*error)));
}

/* Time goes on, and the next step is as long as the error allows; as in `go`. */
static void accept(rider *r, double factor) {
    r->done = r->now == r->length - r->done ? r->length : r->done + r->now;
    factor = factor > 6 ? 6 : factor < 0.2 ? 0.2 : factor;
    if (r->now == r->h || factor < 1) r->h = r->now * factor;
}

static wc_status refuse(rider *r, double factor, double error) {
    r->h = r->now * (factor > 0.1 ? factor : 0.1);
    if (r->h >= WC_SHORTEST) return WC_OK;
    return isfinite(error) ? WC_STEP_TOO_SMALL : WC_NOT_FINITE;
}

/* After a step was tried: whoever is in lane e goes on, tries a shorter one, or makes room. Says whether somebody is in it. */
static int go_on(carriage *a, int e, int accepted, double factor, double error) {
    const course *c = a->c;
    rider *r = a->riders + e;
    long chair = r->chair;
    if (accepted) accept(r, factor);
    else a->status[chair] = refuse(r, factor, error);
    if (a->status[chair] == WC_OK && r->done < r->length && ++r->tries >= wc_most_tries(r->length))
        a->status[chair] = WC_STEP_TOO_SMALL;
    if (a->status[chair] != WC_OK) {
        a->reached[chair] = r->from + 1;
        return board(a, e);
    }
    if (r->done < r->length) return 1;
    keep(a, e, r->to);
    if (r->to + 1 < c->n) {
        turn(a, e, r->to);
        return 1;
    }
    a->reached[chair] = c->n;
    read_out(c, a->own + chair * c->k->parameters, r->rows, a->y + chair * c->results * c->n);
    return board(a, e);
}

/* One step in every lane. Says how many are still in use. */
static int step_on(carriage *a) {
    lanes error, factor;
    attempt(a, &error, &factor);
    masks accepted = error <= 1;
    for (int e = 0; e < WC_LANES; e++)
        if (a->riders[e].chair >= 0 && accepted[e]) fill(a, e, a->riders + e);
    for (int i = 0; i < a->c->k->states; i++) {
        lanes x1 = (lanes)(~(lanes_fabs(a->x1[i]) < WC_NOTHING) & (masks)a->x1[i]);
        a->x[i] = lanes_choose(accepted, x1, a->x[i]);
    }
    int aboard = 0;
    for (int e = 0; e < WC_LANES; e++)
        if (a->riders[e].chair >= 0) aboard += go_on(a, e, accepted[e] != 0, factor[e], error[e]);
    return aboard;
}

/* Inputs that move, each by itself. */
static void find_moving(course *c) {
    int nw = c->k->inputs;
    for (int q = 0; q < nw; q++) {
        long row = 1;
        while (row < c->n && c->w[row * nw + q] == c->w[q]) row++;
        if (row >= c->n) continue;
        for (row = 0; row < c->n; row++) c->inputs[c->movings * c->padded + row] = c->w[row * nw + q];
        c->moving[c->movings++] = q;
    }
}

long wc_lanes_work(const wc_kernel *k, long n) { return (WC_LANES * k->states + k->inputs + 2) * (n + WC_LANES); }

/* Chairs with parameters p (one row each) from their own starts through inputs w (n rows) at times t (n, at least two).
 * y: chairs x results x n. status: of each chair; reached: the number of rows it has done, n where all went well. */
void wc_lanes_run(const wc_kernel *k, int results, double tolerance, long chairs, const double *p, long n, const double *t,
                  const double *w, double *y, int *status, long *reached, double *work) {
    long padded = (n + WC_LANES - 1) / WC_LANES * WC_LANES, *ends = (long *)(work + WC_LANES * k->states * padded);
    double *shares = (double *)(ends + padded), *inputs = shares + padded;
    course c = {.k = k, .tolerance = tolerance, .n = n, .padded = padded, .t = t, .w = w, .results = results,
                .ends = ends, .shares = shares, .inputs = inputs};
    lanes own[k->parameters];
    carriage a = {.c = &c, .p = own, .chairs = chairs, .own = p, .y = y, .status = status, .reached = reached};
    memset(own, 0, sizeof own);
    memset(work, 0, sizeof(double) * (size_t)wc_lanes_work(k, n));
    memset(reached, 0, sizeof(long) * (size_t)chairs);
    for (long i = 0, j = 0; i + 1 < n; i = j) ends[i] = j = straight_until(k, n, i, t, w);
    find_moving(&c);
    for (int q = 0; q < k->inputs; q++) a.wa[q] = a.wb[q] = WC_EVEN(w[q]);
    int aboard = 0;
    for (int e = 0; e < WC_LANES; e++) {
        a.riders[e].rows = work + e * k->states * padded;
        aboard += board(&a, e);
    }
    while (aboard) aboard = step_on(&a);
}
