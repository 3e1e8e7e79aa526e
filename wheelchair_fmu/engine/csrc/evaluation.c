#include "evaluation.h"
#include "rodas.h"

#include <math.h>
#include <string.h>

#define REACH 3.0     /* standard deviations that a start may be moved */
#define SETTLED 0.01  /* and by which it may be off where readings want it */
#define STROKE 0.03   /* s, either side: slopes of a recorded push are taken over this, as over a sample they are mostly noise */
#define LITTLE 1e-3   /* standard deviations of a clock, over which readings' slopes are taken */
#define MOST_STEPS 40 /* that lead a run along forces, or errors of its pushes, at most, */
#define FARTHEST 3.0  /* standard deviations of a force over which slopes hold, */
#define ARRIVED 0.03  /* and of a step that leads nowhere else */
#define GAINED 0.1    /* of -2 log probability, less than which no step is worth another */
#define ROUNDED 1e-9  /* share of what is new of a force that rounding may be */
#define MOMENTS 8     /* up to which readings are asked where errors of the pushes led, */
#define LOST 0.05     /* where more than this share of squares is left than slopes foretell, */
#define HELD 1.0      /* and the sum of squares by which innovations may differ where slopes hold */
#define MOMENT 1      /* of the forces that nobody recorded, the moment, */
#define TREMOR 2      /* that of bumps, */
#define ACROSS 5      /* that of a floor's slope to the side, */
#define SWINGS 6      /* and the first of those by which a body swings, or swings beside its record */
#define SWEEPS 30     /* of Jacobi's rotations */

static const double shares[] = {1.0, 0.5, 0.25, 0.1, 0.03}; /* of a step that are tried */

static int uncertain(const wc_recording *s) { return s->starts + s->constants; }
static int states(const wc_recording *s) { return s->kernel->states; }
static long readings(const wc_recording *s) { return s->n * s->noise.nz; }

/* --- memory --- */

typedef struct {
    double *block;
    long used;
} space;

static double *next(space *in, long count) {
    double *at = in->block ? in->block + in->used : 0;
    in->used += count;
    return at;
}

static void room_of_simulated(const wc_recording *s, wc_simulated *to, space *kept, space *work) {
    to->start = next(kept, uncertain(s));
    to->results = next(work, s->n * s->kernel->outputs);
    to->predicted = next(kept, readings(s));
    to->foretold = next(kept, readings(s));
    to->r = next(kept, readings(s));
}

long wc_simulated_room(const wc_recording *s, wc_simulated *to, double *block) {
    space all = {block, 0};
    room_of_simulated(s, to, &all, &all);
    return all.used;
}

static void room_of_filter(const wc_recording *s, filter *f, space *kept) {
    long n = s->n, nx = states(s), nz = s->noise.nz, nq = s->noise.nq + s->noise.nd;
    f->B = next(kept, (n - 1) * nx * nq);
    f->C = next(kept, (n - 1) * nx * nq);
    f->H = next(kept, n * nz * nx);
    f->D = next(kept, n * nz * nq);
    f->input_sd = next(kept, n * nq);
    f->input_phi = next(kept, (n - 1) * nq);
    f->phi = next(kept, (n - 1) * nz);
    f->start_cov = next(kept, nx * nx);
    f->common = next(kept, nq * nq);
    f->present = (char *)next(kept, n * nz / 8 + 1);
}

static void room_of_slopes(const wc_recording *s, wc_derivatives *by, space *kept, space *work) {
    long n = s->n, nx = states(s), ns = s->tangent->sensors;
    by->active = s->active;
    by->which = s->columns;
    by->forced = s->forced;
    by->transition = next(kept, (n - 1) * nx * nx);
    by->push_before = next(work, (n - 1) * nx * WC_PUSHES);
    by->push_after = next(work, (n - 1) * nx * WC_PUSHES);
    by->by_state = next(work, n * ns * nx);
    by->by_push = next(work, n * ns * WC_PUSHES);
    by->start = next(kept, nx * s->active);
    by->by_parameter = next(work, n * ns * s->active);
}

void wc_evaluation_room(const wc_recording *s, wc_evaluation *e, double *kept_in, double *work_in, long *rooms) {
    space kept = {kept_in, 0}, work = {work_in, 0};
    long n = s->n, nx = states(s), all = readings(s), u = uncertain(s), l = s->constants, nd = s->noise.nd, nq = s->noise.nq;
    long size = nx + nq + nd + s->noise.nz, busy = wc_tangent_work(s->kernel, s->tangent, s->active);
    if (busy < n) busy = n; /* of one series */
    double **each[] = {&e->path, &e->told, &e->spread, &e->measured, &e->added, &e->gain, &e->scale, &e->offset,
                       &e->by_start, &e->slopes, &e->constant, &e->less, &e->as_push};
    long sizes[] = {n * nd, 2, all, all, all, all * size, all, nx + l, all * u, all * u, all * l, l * l, nq * nd};
    double **lent[] = {&e->x, &e->y, &e->driven, &e->p, &e->w, &e->column, &e->busy, &e->innovations, &e->added_again,
                       &e->before, &e->step, &e->noise, &e->none, &e->errors, &e->trial};
    long lengths[] = {n * nx, n * s->kernel->outputs, all, s->kernel->parameters, n * s->kernel->inputs, n, busy, all, all,
                      n * nd + u, n * nd, n * (nq + nd), nx * nx, n * nq, n * nq};
    room_of_simulated(s, &e->own, &kept, &work);
    for (size_t i = 0; i < sizeof each / sizeof *each; i++) *each[i] = next(&kept, sizes[i]);
    for (size_t i = 0; i < sizeof lent / sizeof *lent; i++) *lent[i] = next(&work, lengths[i]);
    e->reached = (long *)next(&work, 1);
    e->pushed = 0;
    e->silent = 0;
    room_of_slopes(s, &e->by, &kept, &work);
    room_of_filter(s, &e->f, &kept);
    e->f.nx = (int)nx;
    e->f.nq = (int)(nq + nd);
    e->f.nz = s->noise.nz;
    e->f.sd = s->noise.sd;
    e->f.A = e->by.transition;
    rooms[0] = kept.used;
    rooms[1] = work.used;
}

/* --- inputs and readings --- */

/* to: a series (n) at times that are later by `later`, and its ends before and after; `to` is every `stride`-th number. */
static void interpolate(const wc_recording *s, const double *from, double later, int stride, double *to) {
    const double *t = s->time;
    long last = s->n - 1, j = 0;
    for (long i = 0; i <= last; i++) {
        double at = t[i] + later, value;
        if (at <= t[0]) value = from[0];
        else if (at >= t[last]) value = from[last];
        else {
            while (t[j + 1] <= at) j++;
            value = from[j] + (from[j + 1] - from[j]) / (t[j + 1] - t[j]) * (at - t[j]);
        }
        to[i * stride] = value;
    }
}

static void move(const wc_recording *s, double later, int stride, double *series, double *column) {
    for (long i = 0; i < s->n; i++) column[i] = series[i * stride];
    interpolate(s, column, later, stride, series);
}

static int has_input(const wc_recording *s, int constant, int input) {
    return s->constant_inputs[constant * s->kernel->inputs + input];
}

/* One input of w as the chair felt it, where a constant has this size. */
static void felt_by(const wc_recording *s, int constant, double size, int stride, double *series, double *column) {
    if (s->constant_kind[constant] == WC_CLOCK) move(s, -size, stride, series, column);
    else for (long i = 0; i < s->n; i++) series[i * stride] -= size * s->constant_shape[constant * s->n + i];
}

/* w: n x inputs, as and when the chair felt them, with constants of these sizes. */
static void felt(const wc_recording *s, const wc_values *v, const double *sizes, double *w, double *column) {
    int nw = s->kernel->inputs;
    memcpy(w, s->inputs, sizeof(double) * (size_t)(s->n * nw));
    for (int j = 0; j < s->constants; j++) {
        for (int i = 0; sizes[j] != 0 && i < nw; i++) {
            if (has_input(s, j, i)) felt_by(s, j, sizes[j], nw, w + i, column);
        }
    }
    for (int i = 0; v->numbers[WC_DELAY] != 0 && i < nw; i++) {
        if (s->late[i]) move(s, -v->numbers[WC_DELAY], nw, w + i, column);
    }
}

/* As what change of the inputs that carry noise a unit of each force acts on a chair of this mass. */
static void as_push(const wc_recording *s, const wc_values *v, double *to) {
    for (int q = 0; q < s->noise.nq; q++) {
        for (int d = 0; d < s->noise.nd; d++) {
            double unit = s->noise.as_push[q * s->noise.nd + d];
            int turns = d == MOMENT || d == TREMOR || d == ACROSS;
            to[q * s->noise.nd + d] = turns ? unit : unit * v->numbers[WC_ALONG];
        }
    }
}

/* What acts besides a record of a push: its error, and what forces of e's path are as pushes. */
static double unrecorded(const wc_recording *s, const wc_evaluation *e, const double *by, long i, int q) {
    int nd = s->noise.nd;
    double sum = e->pushed ? e->pushed[i * s->noise.nq + q] : 0;
    for (int d = 0; d < nd; d++) sum += by[q * nd + d] * e->path[i * nd + d];
    return sum;
}

/* Adds that to the inputs. */
static void act(const wc_recording *s, wc_evaluation *e, const double *by) {
    for (long i = 0; i < s->n; i++) {
        for (int q = 0; q < s->noise.nq; q++) e->w[i * s->kernel->inputs + s->noise.pushes[q]] += unrecorded(s, e, by, i, q);
    }
}

/* to: n x nz, results as their devices read them, with constants of these sizes. */
static void read(const wc_recording *s, const double *sizes, const double *y, double *to, double *column) {
    int nz = s->noise.nz;
    for (long i = 0; i < s->n; i++) {
        for (int z = 0; z < nz; z++) to[i * nz + z] = y[i * s->kernel->outputs + s->tangent->rows[s->noise.which[z]]];
    }
    for (int j = 0; j < s->constants; j++) {
        if (s->constant_kind[j] != WC_CLOCK || sizes[j] == 0) continue;
        for (int z = 0; z < nz; z++) {
            if (s->constant_readings[j * nz + z]) move(s, sizes[j], nz, to + z, column);
        }
    }
}

/* Adds to readings (n x nz) what sensors have of the forces of e's path besides what these do to the chair. */
static void feel(const wc_recording *s, const wc_evaluation *e, double *to) {
    int nz = s->noise.nz, nd = s->noise.nd;
    for (long at = 0; nd && at < readings(s); at++) {
        const double *by = s->noise.as_reading + at % nz * nd, *path = e->path + at / nz * nd;
        for (int d = 0; d < nd; d++) to[at] += by[d] * path[d];
    }
}

static void begin_at(const wc_recording *s, const wc_values *v, const double *start, double *p) {
    memcpy(p, v->p, sizeof(double) * (size_t)s->kernel->parameters);
    for (int c = 0; c < s->starts; c++) p[s->start_places[c]] = start[c];
}

/* Without derivatives, with inputs e->w. */
static int run(const wc_recording *s, const wc_values *v, wc_evaluation *e, const double *start, double *x, double *y) {
    wc_accuracy accuracy = {v->numbers[WC_TOLERANCE], 0};
    long steps = 0;
    begin_at(s, v, start, e->p);
    *e->reached = 0;
    wc_status status = wc_start(s->kernel, e->p, e->w, x);
    return status != WC_OK ? status : wc_run(s->kernel, e->p, accuracy, s->n, s->time, e->w, 0, x, y, e->reached, &steps);
}

/* --- the filter --- */

/* Where the parameters that start the run say that it starts: its covariance, and how far that is from the simulated one. */
static void expect_start(const wc_recording *s, wc_evaluation *e, double *cov) {
    int nx = states(s), first = s->active - s->starts;
    memset(cov, 0, sizeof(double) * (size_t)(nx * nx));
    memset(e->offset, 0, sizeof(double) * (size_t)(nx + s->constants));
    for (int c = 0; c < s->starts; c++) {
        double sd = s->start_sd[c], off = s->start_prior[c] - e->own.start[c];
        for (int r = 0; r < nx; r++) {
            double slope = e->by.start[r * s->active + first + c];
            e->offset[r] += slope * off;
            for (int q = 0; q < nx; q++) cov[r * nx + q] += slope * sd * sd * e->by.start[q * s->active + first + c];
        }
    }
    for (int j = 0; j < s->constants; j++) e->offset[nx + j] = -e->own.start[s->starts + j] / s->constant_sd[j];
}

static void make_filter(const wc_recording *s, wc_evaluation *e) {
    wc_noise noise = s->noise;
    wc_slopes by = {WC_PUSHES, s->tangent->sensors, e->by.push_before, e->by.push_after, e->by.by_state, e->by.by_push};
    noise.as_push = e->as_push;
    expect_start(s, e, (double *)e->f.start_cov);
    wc_compose(&noise, &by, s->n, &e->f);
    for (long at = 0; at < readings(s); at++) e->f.present[at] = !isnan(s->recorded[at]) && !(e->silent && e->silent[at]);
    wc_drop_kinks(&e->f, s->n, *s->usual, s->speeds[0], s->speeds[1]);
    e->told[0] = wc_design(&e->f, s->n, e->gain, e->scale);
    for (long at = 0; at < readings(s); at++) { /* readings that tell nothing are as they were expected */
        if (!isnan(s->recorded[at]) && !e->f.present[at]) e->told[0] += 1 + 2 * log(s->noise.sd[at % s->noise.nz]);
    }
}

/* What one unit of a constant adds to the readings (n x nz), to first order. */
static void slope_of_constant(const wc_recording *s, wc_evaluation *e, int constant, double *to) {
    int nq = e->f.nq, nz = s->noise.nz, nw = s->kernel->inputs, clock = s->constant_kind[constant] == WC_CLOCK;
    double little = LITTLE * s->constant_sd[constant], *change = e->noise, *column = e->column;
    memset(change, 0, sizeof(double) * (size_t)(s->n * nq));
    for (int q = 0; q < s->noise.nq; q++) {
        int input = s->noise.pushes[q];
        if (!has_input(s, constant, input)) continue;
        for (int side = -1; side <= 1; side += 2) {
            for (long i = 0; i < s->n; i++) e->busy[i] = s->inputs[i * nw + input];
            felt_by(s, constant, side * STROKE, 1, e->busy, column);
            for (long i = 0; i < s->n; i++) change[i * nq + q] += side * e->busy[i] / (2 * STROKE);
        }
    }
    wc_respond(&e->f, s->n, change, 0, to);
    for (int z = 0; clock && z < nz; z++) {
        if (!s->constant_readings[constant * nz + z]) continue;
        for (int side = -1; side <= 1; side += 2) {
            for (long i = 0; i < s->n; i++) e->busy[i] = e->driven[i * nz + z];
            move(s, side * little, 1, e->busy, column);
            for (long i = 0; i < s->n; i++) to[i * nz + z] += side * e->busy[i] / (2 * little);
        }
    }
}

static void find_slopes(const wc_recording *s, wc_evaluation *e) {
    int u = uncertain(s), nz = s->noise.nz, ns = s->tangent->sensors, first = s->active - s->starts;
    for (long i = 0; i < s->n; i++) {
        for (int z = 0; z < nz; z++) {
            const double *by = e->by.by_parameter + (i * ns + s->noise.which[z]) * s->active + first;
            double *to = e->by_start + (i * nz + z) * u;
            for (int c = 0; c < s->starts; c++) to[c] = s->start_set[c] ? 0 : by[c];
        }
    }
    for (int j = 0; j < s->constants; j++) {
        slope_of_constant(s, e, j, e->innovations);
        for (long at = 0; at < readings(s); at++) e->by_start[at * u + s->starts + j] = e->innovations[at];
    }
}

/* Eigenvalues of a symmetric matrix (l x l), left on its diagonal, and eigenvectors in the columns of `axes`, by Jacobi. */
static void rotate_all(int l, double *matrix, double *axes) {
    for (int i = 0; i < l * l; i++) axes[i] = i % (l + 1) == 0;
    for (int sweep = 0; sweep < SWEEPS; sweep++) {
        double off = 0, on = 0;
        for (int i = 0; i < l * l; i++) *(i % (l + 1) ? &off : &on) += matrix[i] * matrix[i];
        if (off <= 1e-30 * on) return;
        for (int a = 0; a < l; a++) {
            for (int b = a + 1; b < l; b++) {
                double between = matrix[a * l + b];
                if (between == 0) continue;
                double half = (matrix[b * l + b] - matrix[a * l + a]) / (2 * between);
                double t = (half < 0 ? -1 : 1) / (fabs(half) + sqrt(half * half + 1)), c = 1 / sqrt(t * t + 1), d = t * c;
                for (int i = 0; i < l; i++) {
                    double one = matrix[i * l + a], other = matrix[i * l + b];
                    matrix[i * l + a] = c * one - d * other;
                    matrix[i * l + b] = d * one + c * other;
                }
                for (int i = 0; i < l; i++) {
                    double one = matrix[a * l + i], other = matrix[b * l + i];
                    matrix[a * l + i] = c * one - d * other;
                    matrix[b * l + i] = d * one + c * other;
                }
                for (int i = 0; i < l; i++) {
                    double one = axes[i * l + a], other = axes[i * l + b];
                    axes[i * l + a] = c * one - d * other;
                    axes[i * l + b] = d * one + c * other;
                }
            }
        }
    }
}

/* Innovations x have the covariance 1 + L Lᵀ by constants L, in units of their standard deviations; they are multiplied by its
 * inverse square root, 1 - L less Lᵀ, where less = (1 - 1/√(1 + κ))/κ of κ = Lᵀ L, also where that is 0. */
static int find_constants(const wc_recording *s, wc_evaluation *e) {
    int l = s->constants, u = uncertain(s);
    double square[WC_MOST * WC_MOST], axes[WC_MOST * WC_MOST];
    e->told[1] = 0;
    memset(square, 0, sizeof(double) * (size_t)(l * l));
    for (long at = 0; at < readings(s); at++) {
        for (int j = 0; j < l; j++) e->constant[at * l + j] = e->slopes[at * u + s->starts + j] * s->constant_sd[j];
        for (int j = 0; j < l; j++) {
            for (int k = 0; k < l; k++) square[j * l + k] += e->constant[at * l + j] * e->constant[at * l + k];
        }
    }
    for (int i = 0; i < l * l; i++) if (!isfinite(square[i])) return 0;
    rotate_all(l, square, axes);
    memset(e->less, 0, sizeof(double) * (size_t)(l * l));
    for (int a = 0; a < l; a++) {
        double root = sqrt(1 + fmax(square[a * l + a], 0));
        e->told[1] += 2 * log(root);
        for (int j = 0; j < l; j++) {
            for (int k = 0; k < l; k++) e->less[j * l + k] += axes[j * l + a] * axes[k * l + a] / (root * (root + 1));
        }
    }
    return 1;
}

/* Takes the constants out of m signals (n x nz x m). */
static void marginal(const wc_recording *s, const wc_evaluation *e, int m, double *signals) {
    int l = s->constants;
    for (int c = 0; l && c < m; c++) {
        double told[WC_MOST] = {0}, taken[WC_MOST] = {0};
        for (long at = 0; at < readings(s); at++) wc_add_row(l, signals[at * m + c], e->constant + at * l, told);
        for (int j = 0; j < l; j++) wc_add_row(l, told[j], e->less + j * l, taken);
        for (long at = 0; at < readings(s); at++) {
            for (int j = 0; j < l; j++) signals[at * m + c] -= taken[j] * e->constant[at * l + j];
        }
    }
}

/* Of measured less foretold, as the filter has them (e->innovations) and with constants taken out (r). */
static void innovate(const wc_recording *s, wc_evaluation *e, const double *measured, const double *foretold, double *r) {
    int l = s->constants, nx = states(s);
    for (long at = 0; at < readings(s); at++) e->innovations[at] = measured[at] - foretold[at];
    wc_whiten(&e->f, s->n, e->gain, e->scale, e->offset, 1, e->innovations);
    memcpy(r, e->innovations, sizeof(double) * (size_t)readings(s));
    for (long at = 0; at < readings(s); at++) {
        for (int j = 0; j < l; j++) r[at] -= e->constant[at * l + j] * e->offset[nx + j];
    }
    marginal(s, e, 1, r);
    for (long at = 0; at < readings(s); at++) if (isnan(s->recorded[at])) r[at] = NAN;
}

static void measure(const wc_recording *s, const wc_values *v, double *to) {
    for (long at = 0; at < readings(s); at++) to[at] = s->recorded[at] - v->offsets[at % s->noise.nz];
}

static double prior(const wc_recording *s, int c) { return c < s->starts ? s->start_prior[c] : 0; }
static double prior_sd(const wc_recording *s, int c) { return c < s->starts ? s->start_sd[c] : s->constant_sd[c - s->starts]; }

/* The start, and the constants, given the readings of the first `until` rows, to first order: prior mean + P₀ S₀ᵀ r. */
static void better_start(const wc_recording *s, const wc_evaluation *e, const double *r, long until, double *to) {
    int u = uncertain(s);
    long told = until * s->noise.nz;
    for (int c = 0; c < u; c++) {
        double sum = 0, sd = prior_sd(s, c);
        for (long at = 0; at < told; at++) if (!isnan(r[at])) sum += r[at] * e->slopes[at * u + c];
        to[c] = prior(s, c) + fmin(fmax(sd * sd * sum, -REACH * sd), REACH * sd);
    }
}

/* --- how probable a run is --- */

/* The square of what is new in AR(1) noise of unit variance after what was before, of which `kept` is left; all, where that is 0. */
static double fresh(double now, double before, double kept) {
    double size = (now - kept * before) / sqrt(1 - kept * kept);
    return size * size;
}

static double off(const wc_recording *s, const wc_evaluation *e, const double *driven, long i, int z) {
    long at = i * s->noise.nz + z;
    return e->f.present[at] ? (e->measured[at] - driven[at]) / s->noise.sd[z] : NAN;
}

/* -2 log probability of readings, of errors of the pushes and of the start together, but for a constant. */
static double unlikely(const wc_recording *s, const wc_evaluation *e, const double *driven, const double *pushed,
                       const double *start) {
    int nz = s->noise.nz, nq = s->noise.nq, all = e->f.nq;
    double sum = 0, before[WC_MOST] = {0}, kept[WC_MOST] = {0}; /* of each reading: the last one, and what is left of its noise */
    for (int c = 0; c < uncertain(s); c++) {
        double sd = prior_sd(s, c), apart = start[c] - prior(s, c);
        if (sd > 0) sum += apart * apart / (sd * sd);
    }
    for (long i = 0; i < s->n; i++) {
        for (int z = 0; z < nz; z++) {
            double now = off(s, e, driven, i, z);
            kept[z] *= i ? e->f.phi[(i - 1) * nz + z] : 0;
            if (isnan(now)) continue;
            sum += fresh(now, before[z], kept[z]);
            before[z] = now;
            kept[z] = 1;
        }
        for (int q = 0; q < nq; q++) {
            const double *sd = e->f.input_sd + i * all + q;
            if (!*sd) continue; /* an input without noise */
            double last = i ? pushed[(i - 1) * nq + q] / sd[-all] : 0;
            sum += fresh(pushed[i * nq + q] / *sd, last, i ? e->f.input_phi[(i - 1) * all + q] : 0);
        }
    }
    return sum;
}

/* -2 log probability of the forces of e's path, but for a constant: of processes of first order, some of which one noise drives
 * together. What is new of these is in some directions next to nothing, of which rounding must not be asked. */
static double unlikely_forces(const wc_recording *s, const wc_evaluation *e) {
    int nd = s->noise.nd, nq = s->noise.nq, all = e->f.nq;
    double sum = 0, L[WC_MOST * WC_MOST], fresh_of[WC_MOST];
    for (long i = 0; i < s->n; i++) {
        const double *sd = e->f.input_sd + i * all + nq, *phi = i ? e->f.input_phi + (i - 1) * all + nq : 0;
        for (int d = 0; d < nd; d++) {
            fresh_of[d] = e->path[i * nd + d] - (phi ? phi[d] * e->path[(i - 1) * nd + d] : 0);
            for (int b = 0; b <= d; b++) { /* a row of Cholesky's factor, and what it leaves of the row */
                double kept = phi ? 1 - phi[d] * phi[b] : 1, left = e->f.common[(nq + d) * all + nq + b] * kept * sd[d] * sd[b];
                if (b == d) left *= 1 + ROUNDED;
                for (int c = 0; c < b; c++) left -= L[d * nd + c] * L[b * nd + c];
                L[d * nd + b] = b == d ? sqrt(fmax(left, 0)) : L[b * nd + b] > 0 ? left / L[b * nd + b] : 0;
            }
            for (int b = 0; b < d; b++) fresh_of[d] -= L[d * nd + b] * fresh_of[b];
            fresh_of[d] = L[d * nd + d] > 0 ? fresh_of[d] / L[d * nd + d] : 0;
            sum += fresh_of[d] * fresh_of[d];
        }
    }
    return sum;
}

/* --- one run --- */

static int on_a_path(const wc_recording *s, const wc_evaluation *e) {
    for (long i = 0; i < s->n * s->noise.nd; i++) if (e->path[i] != 0) return 1;
    return e->pushed != 0;
}

/* A run that begins in the middle of a stroke begins at a speed that the body's momentum takes off, and gives back before the
 * stroke is over: without forces, it begins at the speed of both. */
static double without_swing(const wc_recording *s, const wc_values *v, const double *by, const double *path) {
    double momentum = 0;
    int nd = s->noise.nd;
    for (int d = SWINGS; d < nd; d++) {
        for (int q = 0; q < s->noise.nq; q++) momentum += by[q * nd + d] * s->noise.lasting[d] * path[d];
    }
    return momentum / v->numbers[WC_MASS];
}

/* to: n x nz, what the forces of e's path, and errors of the pushes, add to the readings. */
static void add(const wc_recording *s, wc_evaluation *e, const double *by, double *to) {
    int nq = e->f.nq;
    memset(e->noise, 0, sizeof(double) * (size_t)(s->n * nq));
    for (long i = 0; i < s->n; i++) {
        for (int q = 0; q < s->noise.nq; q++) e->noise[i * nq + q] = unrecorded(s, e, by, i, q);
    }
    wc_respond(&e->f, s->n, e->noise, 0, to);
    feel(s, e, to);
}

/* Results and readings without forces and with pushes as recorded, from this start. */
static int alone(const wc_recording *s, const wc_values *v, wc_evaluation *e, const double *by, const double *start,
                       double *x, wc_simulated *to) {
    double from[WC_MOST];
    memcpy(from, start, sizeof(double) * (size_t)uncertain(s));
    from[s->forward] += without_swing(s, v, by, e->path);
    felt(s, v, start + s->starts, e->w, e->column);
    int status = run(s, v, e, from, x, to->results);
    if (status == WC_OK) read(s, start + s->starts, to->results, to->predicted, e->column);
    return status;
}

static int linearise(const wc_recording *s, const wc_values *v, wc_evaluation *e) {
    int led = on_a_path(s, e), u = uncertain(s), nx = states(s);
    felt(s, v, e->own.start + s->starts, e->w, e->column);
    as_push(s, v, e->as_push);
    if (led) act(s, e, e->as_push);
    begin_at(s, v, e->own.start, e->p);
    int status = wc_tangent_run(s->kernel, s->tangent, e->p, v->numbers[WC_TOLERANCE], s->n, s->time, e->w, e->x, e->y,
                                &e->by, e->busy, e->reached);
    if (status != WC_OK) return status;
    read(s, e->own.start + s->starts, e->y, e->driven, e->column);
    feel(s, e, e->driven);
    make_filter(s, e);
    memset(e->added, 0, sizeof(double) * (size_t)readings(s));
    if (led) add(s, e, e->as_push, e->added);
    for (long at = 0; at < readings(s); at++) e->own.foretold[at] = e->driven[at] - e->added[at];
    measure(s, v, e->measured);
    find_slopes(s, e);
    memcpy(e->slopes, e->by_start, sizeof(double) * (size_t)(readings(s) * u));
    memset(e->none, 0, sizeof(double) * (size_t)(nx * nx));
    wc_whiten(&e->f, s->n, e->gain, e->scale, e->none, u, e->slopes);
    if (!find_constants(s, e)) return WC_UNBOUNDED;
    marginal(s, e, u, e->slopes);
    innovate(s, e, e->measured, e->own.foretold, e->own.r);
    if (led) return alone(s, v, e, e->as_push, e->own.start, e->x, &e->own);
    memcpy(e->own.results, e->y, sizeof(double) * (size_t)(s->n * s->kernel->outputs));
    memcpy(e->own.predicted, e->driven, sizeof(double) * (size_t)readings(s));
    return WC_OK;
}

/* The first row of those that the k-th of some moments leaves out, the latest first. */
static long moment(const wc_recording *s, int k) { return (long)((double)s->n - k * ((double)s->n / MOMENTS)); }

/* e->noise: what the first `until` rows of readings have acted, by their innovations (n x nz); `some` has room for these. */
static void ask(const wc_recording *s, wc_evaluation *e, const double *innovations, long until, double *some) {
    for (long at = 0; at < readings(s); at++) some[at] = at < until * s->noise.nz ? innovations[at] : 0;
    wc_smooth(&e->f, s->n, e->gain, e->scale, some, e->noise);
}

/* to: readings (n x nz) from this start, as forces of e's path and these errors of the pushes drive it. */
static int drive(const wc_recording *s, const wc_values *v, wc_evaluation *e, const double *start, const double *errors,
                 double *to) {
    const double *pushed = e->pushed;
    felt(s, v, start + s->starts, e->w, e->column);
    e->pushed = errors;
    act(s, e, e->as_push);
    e->pushed = pushed;
    int status = run(s, v, e, start, e->x, e->y);
    if (status != WC_OK) return status;
    read(s, start + s->starts, e->y, to, e->column);
    feel(s, e, to);
    return WC_OK;
}

/* e->step: from e's path to the forces as the first `until` rows of readings have them; in standard deviations, its largest. */
static double follow(const wc_recording *s, wc_evaluation *e, long until) {
    int nd = s->noise.nd, nq = e->f.nq;
    double most = 0;
    ask(s, e, e->innovations, until, e->added_again);
    for (int d = 0; d < nd; d++) {
        double step = 0, sd = 0; /* largest */
        for (long i = 0; i < s->n; i++) {
            e->step[i * nd + d] = e->noise[i * nq + s->noise.nq + d] - e->path[i * nd + d];
            step = fmax(step, fabs(e->step[i * nd + d]));
            sd = fmax(sd, s->noise.unknown_sd[i * nd + d]);
        }
        if (sd > 0) most = fmax(most, step / sd);
    }
    return most;
}

/* -2 log probability of all together where forces and errors of the pushes drive the readings so (n x nz), but for a constant. */
static double unlikely_led(const wc_recording *s, const wc_evaluation *e, const double *driven, const double *errors) {
    return unlikely(s, e, driven, errors, e->own.start) + unlikely_forces(s, e);
}

/* Back to the path and the start from which the last step was tried. */
static void restore(const wc_recording *s, wc_evaluation *e) {
    long length = s->n * s->noise.nd;
    memcpy(e->path, e->before, sizeof(double) * (size_t)length);
    memcpy(e->own.start, e->before + length, sizeof(double) * (size_t)uncertain(s));
}

/* Takes as much of a step along the forces, of the start's and of the pushes' errors, as makes all together likelier than `least`
 * by more than is nothing; 0 where no share of it does. e->added_again: the readings there. */
static int take(const wc_recording *s, const wc_values *v, wc_evaluation *e, long until, double most, double *least) {
    int u = uncertain(s), nq = s->noise.nq;
    long length = s->n * s->noise.nd, pushes = s->n * nq;
    double better[WC_MOST], *path = e->before, *start = e->before + length;
    better_start(s, e, e->own.r, until, better);
    memcpy(path, e->path, sizeof(double) * (size_t)length);
    memcpy(start, e->own.start, sizeof(double) * (size_t)u);
    for (size_t k = 0; k < sizeof shares / sizeof *shares; k++) {
        double share = shares[k] * most;
        for (int c = 0; c < u; c++) e->own.start[c] = start[c] + share * (better[c] - start[c]);
        for (long i = 0; i < length; i++) e->path[i] = path[i] + share * e->step[i];
        for (long i = 0; i < pushes; i++) {
            e->trial[i] = e->errors[i] + share * (e->noise[i / nq * e->f.nq + i % nq] - e->errors[i]);
        }
        if (drive(s, v, e, e->own.start, e->trial, e->added_again) != WC_OK) continue;
        double found = unlikely_led(s, e, e->added_again, e->trial);
        if (fabs(*least - found) < GAINED) break; /* so is a part of it */
        if (found > *least) continue;
        *least = found;
        memcpy(e->errors, e->trial, sizeof(double) * (size_t)pushes);
        return 1;
    }
    restore(s, e);
    return 0;
}

/* The same of a step to where readings have the forces; where no share of it is likelier, and slopes foretell that much would be,
 * of one to where those up to some moment have them: after it the run may have gone another way than the chair, and slopes about
 * that say nothing. */
static int step(const wc_recording *s, const wc_values *v, wc_evaluation *e, double *least) {
    double squares = 0;
    for (long at = 0; at < readings(s); at++) squares += isnan(e->own.r[at]) ? 0 : e->own.r[at] * e->own.r[at];
    int most = *least - squares > LOST * squares ? MOMENTS : 1;
    for (int k = 0; k < most; k++) {
        double size = follow(s, e, moment(s, k));
        if (size >= ARRIVED && take(s, v, e, moment(s, k), fmin(1, FARTHEST / size), least)) return 1;
    }
    return 0;
}

/* A model that lacks much goes another way than the chair did, and slopes along that way say little of what a force, or another
 * value, would do. So all is linearised about where the readings say that forces led the chair: an iterated smoother, which takes
 * only steps that make all together likelier, as slopes may hold for less than a whole one (Sarkka and Svensson 2020). */
static int lead(const wc_recording *s, const wc_values *v, wc_evaluation *e) {
    memset(e->errors, 0, sizeof(double) * (size_t)(s->n * s->noise.nq));
    double least = unlikely_led(s, e, e->driven, e->errors);
    for (int k = 0; k < MOST_STEPS && step(s, v, e, &least); k++) {
        if (linearise(s, v, e) != WC_OK) { /* it can be run there, and no slope be followed */
            restore(s, e);
            return linearise(s, v, e);
        }
        least = unlikely_led(s, e, e->added_again, e->errors); /* anew, as other readings may tell something from here */
    }
    return WC_OK;
}

static int tune(const wc_recording *s, const wc_values *v, wc_evaluation *e, int rounds) {
    for (int k = 0; k < rounds; k++) {
        double better[WC_MOST];
        int settled = 1;
        better_start(s, e, e->own.r, s->n, better);
        for (int c = 0; c < uncertain(s); c++) settled &= fabs(better[c] - e->own.start[c]) <= SETTLED * prior_sd(s, c);
        if (settled) break;
        memcpy(e->own.start, better, sizeof(double) * (size_t)uncertain(s));
        int status = linearise(s, v, e);
        if (status != WC_OK) return status;
    }
    return WC_OK;
}

void wc_expected(const wc_recording *s, wc_evaluation *e) {
    for (int c = 0; c < uncertain(s); c++) e->own.start[c] = prior(s, c);
    memset(e->path, 0, sizeof(double) * (size_t)(s->n * s->noise.nd));
}

int wc_evaluate(const wc_recording *s, const wc_values *v, wc_evaluation *e, int rounds) {
    *e->reached = 0;
    if (states(s) + s->noise.nq + s->noise.nd + s->noise.nz > WC_MOST || uncertain(s) > WC_MOST) return WC_TOO_MANY;
    int status = linearise(s, v, e);
    if (status == WC_OK && rounds) status = s->leads ? lead(s, v, e) : tune(s, v, e, rounds);
    return status;
}

/* --- errors of the pushes --- */

/* What is tried on the way to errors of the pushes. */
typedef struct {
    double *told, *some, *driven; /* n x nz: innovations, those that are asked, readings with the errors tried */
    double *step, *trial, *best;  /* n x nq */
} trials;

static long room_of_trials(const wc_recording *s, trials *to, double *block) {
    space all = {block, 0};
    double **of_readings[] = {&to->told, &to->some, &to->driven}, **of_pushes[] = {&to->step, &to->trial, &to->best};
    for (int i = 0; i < 3; i++) *of_readings[i] = next(&all, readings(s));
    for (int i = 0; i < 3; i++) *of_pushes[i] = next(&all, s->n * s->noise.nq);
    return all.used;
}

long wc_pushes_room(const wc_recording *s) {
    trials none;
    return room_of_trials(s, &none, 0);
}

/* Do slopes say what is simulated from that start? Innovations allow for another start and other pushes, so that to first order
 * they do not depend on these. */
static int slopes_hold(const wc_recording *s, wc_evaluation *e, const double *start, trials *with) {
    int u = uncertain(s), nq = s->noise.nq;
    double sum = 0;
    memset(e->noise, 0, sizeof(double) * (size_t)(s->n * e->f.nq));
    for (long i = 0; i < s->n; i++) {
        for (int q = 0; q < nq; q++) e->noise[i * e->f.nq + q] = with->trial[i * nq + q];
    }
    wc_respond(&e->f, s->n, e->noise, 0, with->some);
    for (long at = 0; at < readings(s); at++) with->some[at] = with->driven[at] - with->some[at];
    innovate(s, e, e->measured, with->some, with->some);
    for (long at = 0; at < readings(s); at++) {
        double apart = with->some[at] - e->own.r[at];
        for (int c = 0; c < u; c++) apart += e->slopes[at * u + c] * (start[c] - e->own.start[c]);
        if (!isnan(apart)) sum += apart * apart;
    }
    return sum < HELD;
}

/* One step to where readings have the start and the errors of the pushes; moved: 0 where slopes hold as far as that, or no step
 * makes all together likelier. Where a simulation has gone another way than the chair, slopes about it say nothing of what comes
 * after: so besides all readings, those up to each of some moments are asked. */
static int towards(const wc_recording *s, const wc_values *v, wc_evaluation *e, double *errors, trials *with, int *moved) {
    int u = uncertain(s), nq = s->noise.nq;
    long length = s->n * nq;
    double least = unlikely(s, e, e->driven, errors, e->own.start), better[WC_MOST], start[WC_MOST], best[WC_MOST];
    for (long at = 0; at < readings(s); at++) with->told[at] = isnan(e->innovations[at]) ? 0 : e->innovations[at];
    *moved = 0;
    for (int k = 0; k < MOMENTS; k++) {
        long until = moment(s, k);
        ask(s, e, with->told, until, with->some);
        for (long i = 0; i < length; i++) with->step[i] = e->noise[i / nq * e->f.nq + i % nq] - errors[i];
        better_start(s, e, e->own.r, until, better);
        for (size_t j = 0; j < sizeof shares / sizeof *shares; j++) {
            for (int c = 0; c < u; c++) start[c] = e->own.start[c] + shares[j] * (better[c] - e->own.start[c]);
            for (long i = 0; i < length; i++) with->trial[i] = errors[i] + shares[j] * with->step[i];
            if (drive(s, v, e, start, with->trial, with->driven) != WC_OK) continue;
            if (!k && !j && slopes_hold(s, e, start, with)) return WC_OK;
            double found = unlikely(s, e, with->driven, with->trial, start);
            if (found >= least) continue;
            least = found;
            *moved = 1;
            memcpy(best, start, sizeof(double) * (size_t)u);
            memcpy(with->best, with->trial, sizeof(double) * (size_t)length);
        }
    }
    if (!*moved) return WC_OK;
    memcpy(e->own.start, best, sizeof(double) * (size_t)u);
    memcpy(errors, with->best, sizeof(double) * (size_t)length);
    e->pushed = errors;
    return linearise(s, v, e);
}

int wc_follow_pushes(const wc_recording *s, const wc_values *v, wc_evaluation *e, double *errors, double *work) {
    trials with;
    room_of_trials(s, &with, work);
    if (!e->pushed) memset(errors, 0, sizeof(double) * (size_t)(s->n * s->noise.nq));
    for (int k = 0, moved = 1; k < MOST_STEPS && moved; k++) {
        int status = towards(s, v, e, errors, &with, &moved);
        if (status != WC_OK) return status;
    }
    return WC_OK;
}

void wc_find_spread(const wc_recording *s, wc_evaluation *e) {
    filter certain = e->f;
    certain.start_cov = e->none;
    wc_spread(&certain, s->n, e->spread);
}

/* Moves readings from e's start to another one, to first order. */
static void shift(const wc_recording *s, const wc_evaluation *e, const double *start, double *to) {
    int u = uncertain(s);
    for (int c = 0; c < u; c++) {
        double step = start[c] - e->own.start[c];
        for (long at = 0; step != 0 && at < readings(s); at++) to[at] += step * e->by_start[at * u + c];
    }
}

int wc_again(const wc_recording *s, const wc_values *v, wc_evaluation *e, int kept, double *x, wc_simulated *to) {
    int led = on_a_path(s, e);
    double by[WC_MOST], *measured = to->predicted;
    felt(s, v, e->own.start + s->starts, e->w, e->column);
    as_push(s, v, by);
    if (led) act(s, e, by);
    int status = run(s, v, e, e->own.start, x, to->results);
    if (status != WC_OK) return status;
    read(s, e->own.start + s->starts, to->results, to->foretold, e->column);
    feel(s, e, to->foretold);
    if (led && !kept) add(s, e, by, e->added_again);
    const double *added = kept ? e->added : e->added_again;
    for (long at = 0; led && at < readings(s); at++) to->foretold[at] -= added[at];
    measure(s, v, measured);
    innovate(s, e, measured, to->foretold, to->r);
    memcpy(to->start, e->own.start, sizeof(double) * (size_t)uncertain(s));
    if (!kept) better_start(s, e, to->r, s->n, to->start);
    if (led && !kept) status = alone(s, v, e, by, e->own.start, x, to);
    else memcpy(to->predicted, to->foretold, sizeof(double) * (size_t)readings(s));
    shift(s, e, to->start, to->predicted);
    shift(s, e, to->start, to->foretold);
    return status;
}

/* --- what is told --- */

void wc_errors(const wc_recording *s, const wc_values *v, const wc_evaluation *e, const wc_simulated *of, double *errors,
               double *sums) {
    int nz = s->noise.nz;
    memset(sums, 0, sizeof(double) * (size_t)(3 * nz));
    for (long at = 0; at < readings(s); at++) {
        int z = (int)(at % nz);
        double measured = s->recorded[at] - v->offsets[z], apart = measured - of->predicted[at], *sum = sums + 3 * z;
        errors[at] = s->drifts[z] ? of->r[at] : (measured - of->foretold[at]) * e->spread[at];
        if (isnan(errors[at])) continue;
        sum[0] += errors[at] * errors[at];
        sum[1] += 1;
        sum[2] += apart * apart;
    }
}

void wc_normal(const wc_recording *s, const wc_evaluation *e, int k, const double *steps, const double *moved, double *jtj,
               double *jtr, double *squares) {
    memset(jtj, 0, sizeof(double) * (size_t)(k * k));
    memset(jtr, 0, sizeof(double) * (size_t)k);
    *squares = 0;
    for (long at = 0; at < readings(s); at++) {
        double r = e->own.r[at];
        if (!isfinite(r)) continue;
        *squares += r * r;
        double by[WC_MOST];
        for (int a = 0; a < k; a++) by[a] = (moved[a * readings(s) + at] - r) / steps[a];
        for (int a = 0; a < k; a++) {
            jtr[a] += by[a] * r;
            for (int b = 0; b < k; b++) jtj[a * k + b] += by[a] * by[b];
        }
    }
}

void wc_as_read(const wc_recording *s, const wc_values *v, const double *predicted, double *to) {
    for (long at = 0; at < readings(s); at++) to[at] = predicted[at] + v->offsets[at % s->noise.nz];
}

void wc_doubt(const wc_recording *s, int k, const double *base, const double *steps, const double *moved,
              const double *covariance, double *variance) {
    for (long at = 0; at < readings(s); at++) {
        double by[WC_MOST];
        for (int a = 0; a < k; a++) by[a] = (moved[a * readings(s) + at] - base[at]) / steps[a];
        variance[at] = 0;
        for (int a = 0; a < k; a++) {
            for (int b = 0; b < k; b++) variance[at] += by[a] * covariance[a * k + b] * by[b];
        }
    }
}
