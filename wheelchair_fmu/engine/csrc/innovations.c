/* Whitening by a Kalman filter: what is new in each reading, in units of its own uncertainty.
 *
 * Deviations from a simulated run obey
 *     e(i+1) = A(i) e(i) + B(i) q(i) + C(i) q(i+1),    z(i) = H(i) e(i) + D(i) q(i) + a(i),
 * with q the noise of the recorded inputs and a that of the readings, an AR(1) process each, whose coefficients may
 * differ from interval to interval, as samples of several loggers are not evenly spaced. The filter
 * turns z into independent innovations of variance 1; being linear it does the same to any signal that
 * may hide in z, so residuals and sensitivities go through alike.
 * Its gains depend on the variances only: they are designed once and applied to as many signals as come.
 *
 * The filter's own state is s = (e, q, a), of size nx + nq + nz. Of inputs that never have noise, as of forces that were found
 * to be none, there is nothing to learn: they are left out of it while covariances and signals are carried on.
 */
#include "innovations.h"
#include "rows.h"

#include <math.h>
#include <string.h>

#define AROUND 0.05     /* s, each way, of where a speed that */
#define REMEMBERS 10.0  /* fades at less than this rate, 1/s, and then */
#define FORGETS 100.0   /* at more: a chair comes to rest */
#define OFF 0.02        /* m/s, a speed's usual error */
#define STEEP 10.0      /* standard deviations of a reading, by such an error */
#define CHANGING 1.1    /* ratio of a reading's slopes about there, above which it tells nothing */

static inline void add_row(int m, double factor, const double *restrict from, double *restrict to) {
    if (factor == 0) return;
    for (int c = 0; c < m; c++) to[c] += factor * from[c];
}

static inline double common(const filter *f, int q, int p) { return f->common ? f->common[q * f->nq + p] : q == p; }

/* Does a reading's own noise last from one sample to the next? Where it does not, it is no part of s. */
static int lasts(const filter *f, long n) {
    for (long at = 0; at < (n - 1) * f->nz; at++) if (f->phi[at] != 0) return 1;
    return 0;
}

/* The inputs that ever have noise, whether these are all, and the size of s with these alone. */
typedef struct {
    int n, which[WC_MOST], all, lasting, size; /* is the readings' own noise in it? */
} acting;

static acting acting_of(const filter *f, long n) {
    acting a = {0};
    for (int q = 0; q < f->nq; q++) {
        int silent = 1;
        for (long i = 0; silent && i < n; i++) silent = f->input_sd[i * f->nq + q] == 0;
        if (!silent) a.which[a.n++] = q;
    }
    a.all = a.n == f->nq;
    a.lasting = lasts(f, n);
    a.size = f->nx + a.n + (a.lasting ? f->nz : 0);
    return a;
}

/* Of a row of all inputs, what belongs to those that act. */
static inline void take(const acting *a, const double *row, double *to) {
    if (a->all) memcpy(to, row, sizeof(double) * (size_t)a->n);
    else for (int q = 0; q < a->n; q++) to[q] = row[a->which[q]];
}

/* The same where it lies, or in `room`. */
static inline const double *taken(const acting *a, const double *row, double *room) {
    if (a->all) return row;
    take(a, row, room);
    return room;
}

/* Where element k of s stands among all of them. */
static inline int place(const filter *f, const acting *a, int k) {
    int own = f->nx + a->n;
    return k < f->nx ? k : k < own ? f->nx + a->which[k - f->nx] : k - own + f->nx + f->nq;
}

/* The gains of what is in s, of all, where they lie, or in `room`. */
static inline const double *gains(const filter *f, const acting *a, const double *all, double *room) {
    if (a->all) return all;
    for (int r = 0; r < a->size; r++) room[r] = all[place(f, a, r)];
    return room;
}

/* Of all of s but the states, the share that stays from sample i to i+1. */
static inline void find_stays(const filter *f, const acting *a, long i, double *stays) {
    take(a, f->input_phi + i * f->nq, stays);
    if (a->lasting) memcpy(stays + a->n, f->phi + i * f->nz, sizeof(double) * (size_t)f->nz);
}

/* F of the states (nx rows of nx + the inputs that act): what takes them from sample i to i+1, but for fresh noise, of which C
 * (nx rows of these inputs) says what it does. phi: the share of each of these inputs that stays. */
static inline void find_motion(const filter *f, const acting *a, long i, const double *phi, double *F, double *C) {
    int nx = f->nx, nq = a->n;
    for (int r = 0; r < nx; r++, F += nx + nq, C += nq) {
        memcpy(F, f->A + (i * nx + r) * nx, sizeof(double) * (size_t)nx);
        take(a, f->B + (i * nx + r) * f->nq, F + nx);
        take(a, f->C + (i * nx + r) * f->nq, C);
        for (int q = 0; q < nq; q++) F[nx + q] += C[q] * phi[q];
    }
}

/* --- covariances --- */

/* The covariance of s, in rows of whole lanes. */
typedef struct {
    acting a;
    int stride;
    double P[WC_MOST * WC_MOST];
} covariance;

static void begin(const filter *f, long n, covariance *c) {
    c->a = acting_of(f, n);
    int nx = f->nx, nq = c->a.n, own = nx + nq, size = c->a.size;
    double sd[WC_MOST];
    take(&c->a, f->input_sd, sd);
    c->stride = padded(size);
    memset(c->P, 0, sizeof(double) * (size_t)(size * c->stride));
    for (int r = 0; r < nx; r++) memcpy(c->P + r * c->stride, f->start_cov + r * nx, sizeof(double) * (size_t)nx);
    for (int q = 0; q < nq; q++) {
        double *row = c->P + (nx + q) * c->stride + nx;
        for (int p = 0; p < nq; p++) row[p] = common(f, c->a.which[q], c->a.which[p]) * sd[q] * sd[p];
    }
    for (int z = 0; z < size - own; z++) c->P[(own + z) * (c->stride + 1)] = f->sd[z] * f->sd[z];
}

/* rows: what fresh noise of each input at i+1 (nq) shares with s there, through the states, by C (nx x nq), and in itself. phi:
 * the share of each that stays. */
static void find_fresh(const filter *f, const acting *a, long i, int stride, const double *phi, const double *C, double *rows) {
    int nx = f->nx, nq = a->n;
    double sd[WC_MOST];
    take(a, f->input_sd + (i + 1) * f->nq, sd);
    memset(rows, 0, sizeof(double) * (size_t)(nq * stride));
    for (int q = 0; q < nq; q++) {
        for (int p = 0; p < nq; p++) {
            double factor = common(f, a->which[q], a->which[p]);
            if (factor == 0) continue;
            double shared = factor * (1 - phi[q] * phi[p]) * sd[q] * sd[p];
            for (int r = 0; r < nx; r++) rows[q * stride + r] += shared * C[r * nq + p];
            rows[q * stride + nx + p] += shared;
        }
    }
}

/* P at sample i+1 from P at i: F P Fᵀ, of which the states' own part is all that takes a second product, and fresh noise. */
static void predict(const filter *f, long i, covariance *c) {
    int stride = c->stride, nx = f->nx, nq = c->a.n, both = nx + nq, size = c->a.size, short_stride = padded(nx);
    double F[WC_MOST * WC_MOST], T[WC_MOST * WC_MOST], U[WC_MOST * WC_MOST], fresh[WC_MOST * WC_MOST], C[WC_MOST * WC_MOST];
    double stays[WC_MOST], *P = c->P;
    find_stays(f, &c->a, i, stays);
    find_motion(f, &c->a, i, stays, F, C);
    memset(T, 0, sizeof(double) * (size_t)(nx * stride));
    for (int r = 0; r < nx; r++) add_rows(stride, 1, &(weighed_rows){both, P, stride, F + r * both, 1}, T + r * stride);
    memset(U, 0, sizeof(double) * (size_t)(both * short_stride));
    for (int k = 0; k < both; k++) {
        for (int r = 0; r < nx; r++) U[k * short_stride + r] = T[r * stride + k];
    }
    find_fresh(f, &c->a, i, stride, stays, C, fresh);
    for (int k = nx; k < size; k++) {
        double stay = stays[k - nx];
        for (int j = nx; j < size; j++) P[k * stride + j] *= stay * stays[j - nx];
        for (int r = 0; r < nx; r++) P[r * stride + k] = stay * T[r * stride + k];
        if (k < both) add_row_of(stride, 1, fresh + (k - nx) * stride, P + k * stride);
        else P[k * stride + k] += (1 - stay * stay) * f->sd[k - both] * f->sd[k - both];
    }
    for (int r = 0; r < nx; r++) {
        double sum[WC_MOST] = {0};
        add_rows(short_stride, 1, &(weighed_rows){both, U, short_stride, F + r * both, 1}, sum);
        memcpy(P + r * stride, sum, sizeof(double) * (size_t)nx);
        add_rows(stride, 1, &(weighed_rows){nq, fresh, stride, C + r * nq, 1}, P + r * stride);
        for (int k = nx; k < size; k++) P[k * stride + r] = P[r * stride + k];
    }
}

/* Variance of reading z at sample i, and Ph, its covariance with s. */
static double expect(const filter *f, long i, int z, const covariance *c, double *Ph) {
    int stride = c->stride, nx = f->nx, nq = c->a.n, own = nx + nq + z;
    const double *H = f->H + (i * f->nz + z) * nx;
    double room[WC_MOST];
    const double *D = taken(&c->a, f->D + (i * f->nz + z) * f->nq, room);
    if (c->a.lasting) memcpy(Ph, c->P + own * stride, sizeof(double) * (size_t)stride);
    else memset(Ph, 0, sizeof(double) * (size_t)stride);
    add_rows(stride, 1, &(weighed_rows){nx, c->P, stride, H, 1}, Ph);
    add_rows(stride, 1, &(weighed_rows){nq, c->P + nx * stride, stride, D, 1}, Ph);
    double variance = c->a.lasting ? Ph[own] : f->sd[z] * f->sd[z];
    for (int k = 0; k < nx; k++) variance += H[k] * Ph[k];
    for (int q = 0; q < nq; q++) variance += D[q] * Ph[nx + q];
    return variance;
}

/* The same, and P once the reading is known. */
static double hear(const filter *f, long i, int z, covariance *c, double *Ph) {
    double variance = expect(f, i, z, c, Ph);
    for (int r = 0; r < c->a.size; r++) add_row_of(c->stride, -(Ph[r] / variance), Ph, c->P + r * c->stride);
    return variance;
}

double wc_design(const filter *f, long n, double *gain, double *scale) {
    int both = f->nx + f->nq, size = both + f->nz;
    double Ph[WC_MOST], total = 0;
    covariance c;
    if (size > WC_MOST) return NAN;
    begin(f, n, &c);
    memset(gain, 0, sizeof(double) * (size_t)(n * f->nz * size));
    for (long i = 0; i < n; i++) {
        if (i) predict(f, i - 1, &c);
        for (int z = 0; z < f->nz; z++) {
            double *K = gain + (i * f->nz + z) * size;
            scale[i * f->nz + z] = 0;
            if (!f->present[i * f->nz + z]) continue;
            double variance = hear(f, i, z, &c, Ph);
            scale[i * f->nz + z] = 1 / sqrt(variance);
            total += log(variance);
            for (int r = 0; r < c.a.size; r++) K[place(f, &c.a, r)] = Ph[r] / variance;
            if (!c.a.lasting) K[both + z] = f->sd[z] * f->sd[z] / variance;
        }
    }
    return total;
}

/* --- signals --- */

/* s of some signals side by side, in rows of whole lanes, one sample on. */
static void carry(const filter *f, const acting *a, long i, const double *S, double *next, int stride) {
    int nx = f->nx, both = nx + a->n;
    double F[WC_MOST * WC_MOST], C[WC_MOST * WC_MOST], stays[WC_MOST];
    find_stays(f, a, i, stays);
    find_motion(f, a, i, stays, F, C);
    memset(next, 0, sizeof(double) * (size_t)(a->size * stride));
    for (int r = 0; r < nx; r++) add_rows(stride, 1, &(weighed_rows){both, S, stride, F + r * both, 1}, next + r * stride);
    for (int k = nx; k < a->size; k++) add_row_of(stride, stays[k - nx], S + k * stride, next + k * stride);
}

/* What is new in a reading of these signals, given s, which it then corrects. */
static void correct(const filter *f, const acting *a, long at, const double *gain, double *S, double *signal, int stride) {
    int nx = f->nx, nq = a->n, own = nx + nq + (int)(at % f->nz);
    double room[2][WC_MOST];
    const double *D = taken(a, f->D + at * f->nq, room[0]), *K = gains(f, a, gain, room[1]);
    add_rows(stride, -1, &(weighed_rows){nx, S, stride, f->H + at * nx, 1}, signal);
    add_rows(stride, -1, &(weighed_rows){nq, S + nx * stride, stride, D, 1}, signal);
    if (a->lasting) add_row_of(stride, -1, S + own * stride, signal);
    for (int r = 0; r < a->size; r++) add_row_of(stride, K[r], signal, S + r * stride);
}

/* Whitens `some` of the m signals, the first of which is `signals`; start_mean is of this one, if it is the first of all. */
static void whiten(const filter *f, const acting *a, long n, const double *gain, const double *scale, const double *start_mean,
                   int m, int some, double *signals) {
    int stride = padded(some), nx = f->nx, nz = f->nz, all = nx + f->nq + nz;
    double one[WC_MOST * LANES * LANE], other[WC_MOST * LANES * LANE], *S = one, *next = other, signal[LANES * LANE] = {0};
    memset(S, 0, sizeof(double) * (size_t)(a->size * stride));
    for (int r = 0; start_mean && r < nx; r++) S[r * stride] = start_mean[r];
    for (long i = 0; i < n; i++) {
        if (i) {
            carry(f, a, i - 1, S, next, stride);
            double *kept = S;
            S = next;
            next = kept;
        }
        for (long at = i * nz; at < (i + 1) * nz; at++) {
            double *to = signals + at * m;
            if (!f->present[at]) {
                memset(to, 0, sizeof(double) * (size_t)some);
                continue;
            }
            memcpy(signal, to, sizeof(double) * (size_t)some);
            correct(f, a, at, gain + at * all, S, signal, stride);
            for (int j = 0; j < some; j++) to[j] = signal[j] * scale[at];
        }
    }
}

/* s of one signal, one sample on. */
static void carry_one(const filter *f, const acting *a, long i, const double *s, double *next) {
    int nx = f->nx, nq = a->n;
    double stays[WC_MOST], room[2][WC_MOST];
    find_stays(f, a, i, stays);
    for (int k = nx; k < a->size; k++) next[k] = stays[k - nx] * s[k];
    for (int r = 0; r < nx; r++) {
        const double *A = f->A + (i * nx + r) * nx, *B = taken(a, f->B + (i * nx + r) * f->nq, room[0]);
        const double *C = taken(a, f->C + (i * nx + r) * f->nq, room[1]);
        double sum = 0;
        for (int k = 0; k < nx; k++) sum += A[k] * s[k];
        for (int q = 0; q < nq; q++) sum += B[q] * s[nx + q] + C[q] * next[nx + q];
        next[r] = sum;
    }
}

/* What a reading is expected to be. */
static double expected(const filter *f, const acting *a, long at, const double *s) {
    int nx = f->nx, nq = a->n;
    double room[WC_MOST], sum = a->lasting ? s[nx + nq + at % f->nz] : 0;
    const double *D = taken(a, f->D + at * f->nq, room);
    for (int k = 0; k < nx; k++) sum += f->H[at * nx + k] * s[k];
    for (int q = 0; q < nq; q++) sum += D[q] * s[nx + q];
    return sum;
}

/* One signal, which is what is most asked for. */
static void whiten_one(const filter *f, const acting *a, long n, const double *gain, const double *scale,
                       const double *start_mean, double *signal) {
    int nz = f->nz, all = f->nx + f->nq + nz;
    double one[WC_MOST] = {0}, other[WC_MOST], room[WC_MOST], *s = one, *next = other;
    memcpy(s, start_mean, sizeof(double) * (size_t)f->nx);
    for (long i = 0; i < n; i++) {
        if (i) {
            carry_one(f, a, i - 1, s, next);
            double *kept = s;
            s = next;
            next = kept;
        }
        for (long at = i * nz; at < (i + 1) * nz; at++) {
            double told = f->present[at] ? signal[at] - expected(f, a, at, s) : 0;
            if (f->present[at]) add_row(a->size, told, gains(f, a, gain + at * all, room), s);
            signal[at] = told * scale[at];
        }
    }
}

void wc_whiten(const filter *f, long n, const double *gain, const double *scale, const double *start_mean, int m,
               double *signals) {
    acting a = acting_of(f, n);
    if (m == 1) {
        whiten_one(f, &a, n, gain, scale, start_mean, signals);
        return;
    }
    for (int first = 0, some; first < m; first += some) {
        some = m - first < LANES * LANE ? m - first : LANES * LANE;
        whiten(f, &a, n, gain, scale, first ? 0 : start_mean, m, some, signals + first);
    }
}

double wc_deviance(const filter *f, long n, const double *start_mean, const double *residual) {
    int nz = f->nz;
    double Ph[WC_MOST], one[WC_MOST] = {0}, other[WC_MOST], *s = one, *next = other, total = 0;
    covariance c;
    if (f->nx + f->nq + nz > WC_MOST) return NAN;
    begin(f, n, &c);
    memcpy(s, start_mean, sizeof(double) * (size_t)f->nx);
    for (long i = 0; i < n; i++) {
        if (i) {
            predict(f, i - 1, &c);
            carry_one(f, &c.a, i - 1, s, next);
            double *kept = s;
            s = next;
            next = kept;
        }
        for (int z = 0; z < nz; z++) {
            long at = i * nz + z;
            if (!f->present[at]) continue;
            double variance = hear(f, i, z, &c, Ph), told = residual[at] - expected(f, &c.a, at, s);
            total += told * told / variance + log(variance);
            add_row(c.a.size, told / variance, Ph, s);
        }
    }
    return total;
}

void wc_respond(const filter *f, long n, const double *change, double *states, double *readings) {
    int nx = f->nx, nq = f->nq;
    double e[WC_MOST] = {0}, next[WC_MOST];
    for (long i = 0; i < n; i++) {
        const double *now = change + i * nq, *before = now - nq;
        for (int r = 0; i && r < nx; r++) {
            long row = (i - 1) * nx + r;
            next[r] = 0;
            for (int k = 0; k < nx; k++) next[r] += f->A[row * nx + k] * e[k];
            for (int q = 0; q < nq; q++) next[r] += f->B[row * nq + q] * before[q] + f->C[row * nq + q] * now[q];
        }
        if (i) memcpy(e, next, sizeof(double) * (size_t)nx);
        if (states) memcpy(states + i * nx, e, sizeof(double) * (size_t)nx);
        for (long at = i * f->nz; at < (i + 1) * f->nz; at++) {
            readings[at] = 0;
            for (int k = 0; k < nx; k++) readings[at] += f->H[at * nx + k] * e[k];
            for (int q = 0; q < nq; q++) readings[at] += f->D[at * nq + q] * now[q];
        }
    }
}

/* to = Fᵀ from: what a change of s at sample i does to what `from` is of at i+1. */
static void carry_back(const filter *f, long i, const double *from, double *to) {
    int nx = f->nx, nq = f->nq, nz = f->nz;
    memset(to, 0, sizeof(double) * (size_t)(nx + nq + nz));
    for (int r = 0; r < nx; r++) add_row(nx, from[r], f->A + (i * nx + r) * nx, to);
    for (int q = 0; q < nq; q++) {
        double phi = f->input_phi[i * nq + q];
        to[nx + q] = phi * from[nx + q];
        for (int r = 0; r < nx; r++) {
            long at = (i * nx + r) * nq + q;
            to[nx + q] += (f->B[at] + f->C[at] * phi) * from[r];
        }
    }
    for (int z = 0; z < nz; z++) to[nx + nq + z] = f->phi[i * nz + z] * from[nx + nq + z];
}

/* What all readings from sample i on say of s there comes back as a vector b: of s = s⁻ + P⁻ b no covariance but that of fresh
 * noise is needed, as s(i+1) = F s(i) + Q b(i+1) (Koopman 1993, "Disturbance smoother for state space models"). */
void wc_smooth(const filter *f, long n, const double *gain, const double *scale, const double *innovations, double *noise) {
    int nx = f->nx, nq = f->nq, nz = f->nz, size = nx + nq + nz;
    double b[WC_MOST] = {0}, before[WC_MOST];
    for (long i = n - 1; i >= 0; i--) {
        for (int z = nz - 1; z >= 0; z--) {
            long at = i * nz + z;
            if (!f->present[at]) continue;
            double told = innovations[at] * scale[at];
            for (int r = 0; r < size; r++) told -= gain[at * size + r] * b[r];
            add_row(nx, told, f->H + at * nx, b);
            add_row(nq, told, f->D + at * nq, b + nx);
            b[nx + nq + z] += told;
        }
        for (int q = 0; q < nq; q++) {
            double of_fresh = b[nx + q];
            for (int r = 0; i && r < nx; r++) of_fresh += f->C[((i - 1) * nx + r) * nq + q] * b[r];
            noise[i * nq + q] = of_fresh;
        }
        if (!i) break;
        carry_back(f, i - 1, b, before);
        memcpy(b, before, sizeof(double) * (size_t)size);
    }
    for (long i = 0; i < n; i++) {
        double *now = noise + i * nq, fresh_now[WC_MOST];
        const double *sd = f->input_sd + i * nq, *phi = f->input_phi + (i - 1) * nq;
        for (int q = 0; q < nq; q++) {
            fresh_now[q] = 0;
            for (int p = 0; p < nq; p++) {
                double factor = common(f, q, p) * sd[q] * sd[p];
                if (factor != 0) fresh_now[q] += factor * (i ? 1 - phi[q] * phi[p] : 1) * now[p];
            }
        }
        for (int q = 0; q < nq; q++) now[q] = fresh_now[q] + (i ? phi[q] * (now - nq)[q] : 0);
    }
}

static int swings(const filter *f, int q) {
    for (int p = 0; p < f->nq; p++) if (p != q && common(f, q, p) != 0) return 1;
    return 0;
}

/* Inputs that one noise drives together push without a mean: what a unit of one, forgotten over T, has done to a state until
 * now, T times what an impulse does, it undoes again. */
static double undone(const filter *f, int state, int q) {
    long at = (long)state * f->nq + q;
    return swings(f, q) ? (f->B[at] + f->C[at]) / log(f->input_phi[q]) : 0; /* -T / dt = 1 / log φ */
}

/* A simulation without such inputs begins where that is undone already. */
static void begin_undone(const filter *f, covariance *c) {
    int nx = f->nx, nq = c->a.n, n = c->stride;
    double *P = c->P;
    for (int r = 0; r < nx; r++) {
        for (int q = 0; q < nq; q++) {
            add_row(nq, undone(f, r, c->a.which[q]), P + (nx + q) * n + nx, P + r * n + nx);
        }
        for (int q = 0; q < nq; q++) P[(nx + q) * n + r] = P[r * n + nx + q];
    }
    for (int r = 0; r < nx; r++) {
        for (int q = 0; q < nq; q++) add_row(nx, undone(f, r, c->a.which[q]), P + (nx + q) * n, P + r * n);
    }
}

void wc_spread(const filter *f, long n, double *scale) {
    double Ph[WC_MOST];
    covariance c;
    begin(f, n, &c);
    if (n > 1) begin_undone(f, &c);
    for (long i = 0; i < n; i++) {
        if (i) predict(f, i - 1, &c);
        for (int z = 0; z < f->nz; z++) scale[i * f->nz + z] = 1 / sqrt(expect(f, i, z, &c, Ph));
    }
}

/* Does a state keep more than `much` of itself from one sample to the next here, and less than `little` there, from … to? */
static int rests(const filter *f, long from, long to, int state, double much, double little) {
    double least = INFINITY, most = -INFINITY;
    for (long i = from; i <= to; i++) {
        double kept = f->A[((i ? i - 1 : 0) * f->nx + state) * f->nx + state];
        least = fmin(least, kept);
        most = fmax(most, kept);
    }
    return most > much && least < little;
}

/* Is reading z steep by a state, and steeper here than there? */
static int bends(const filter *f, long from, long to, int z, int state) {
    double least = INFINITY, most = 0;
    for (long i = from; i <= to; i++) {
        double slope = fabs(f->H[(i * f->nz + z) * f->nx + state]);
        least = fmin(least, slope);
        most = fmax(most, slope);
    }
    return most * OFF > STEEP * f->sd[z] && most > CHANGING * least;
}

void wc_drop_kinks(const filter *f, long n, double dt, int forward, int sideways) {
    long half = AROUND / dt < 1 ? 1 : (long)(AROUND / dt + 0.5);
    double much = exp(-REMEMBERS * dt), little = exp(-FORGETS * dt);
    for (long i = 0; i < n; i++) {
        long from = i < half ? 0 : i - half, to = i + half < n ? i + half : n - 1;
        if (!rests(f, from, to, forward, much, little)) continue;
        for (int z = 0; z < f->nz; z++) {
            if (bends(f, from, to, z, forward) || bends(f, from, to, z, sideways)) f->present[i * f->nz + z] = 0;
        }
    }
}

/* AR(1) coefficient over some of the time between two samples of a series. Rows belong to several loggers, so most intervals
 * are shorter than a series' own step. */
static double over(double ar, double seconds, double step) { return ar > 0 ? pow(ar, seconds / step) : 0; }

/* Standard deviation of a recorded push at a row. What noise adds to the chair's momentum must not depend on how many rows lie
 * between two samples of a push. In a time T that has a variance of σ² T h (1 + φ)/(1 - φ) for rows h apart, so σ goes with the
 * rows' distance. */
static double at_row(const wc_noise *s, long n, long i, int q) {
    const double *t = s->time;
    double around = i == 0 ? t[1] - t[0] : i == n - 1 ? t[n - 1] - t[n - 2] : ((t[i + 1] - t[i]) + (t[i] - t[i - 1])) / 2;
    double ar = s->push_ar[q], there = over(ar, around, s->push_step[q]), lasting = s->push_step[q] * (1 + ar) / (1 - ar);
    return s->push_sd[q] * sqrt(lasting / (around * (1 + there) / (1 - there)));
}

static void compose_inputs(const wc_noise *s, long n, filter *f) {
    int nq = s->nq, both = nq + s->nd;
    for (long i = 0; i < n; i++) {
        double gap = i + 1 < n ? s->time[i + 1] - s->time[i] : 0;
        for (int q = 0; q < both; q++) {
            f->input_sd[i * both + q] = q < nq ? at_row(s, n, i, q) : s->unknown_sd[i * s->nd + q - nq];
            if (i + 1 == n) continue;
            double keeps = q < nq ? over(s->push_ar[q], gap, s->push_step[q]) : exp(-gap / s->lasting[i * s->nd + q - nq]);
            f->input_phi[i * both + q] = keeps;
        }
        for (int z = 0; i + 1 < n && z < s->nz; z++) f->phi[i * s->nz + z] = over(s->ar[z], gap, s->step[z]);
    }
    for (int q = 0; q < both; q++) {
        for (int p = 0; p < both; p++) {
            int unknown = q >= nq && p >= nq;
            f->common[q * both + p] = unknown ? s->together[(q - nq) * s->nd + p - nq] : q == p;
        }
    }
}

/* to: what all inputs of the filter do, from what each of all pushes does. */
static void compose_row(const wc_noise *s, const double *from, double *to) {
    for (int q = 0; q < s->nq; q++) to[q] = from[s->pushes[q]];
    for (int d = 0; d < s->nd; d++) {
        double sum = 0;
        for (int q = 0; q < s->nq; q++) sum += to[q] * s->as_push[q * s->nd + d];
        to[s->nq + d] = sum;
    }
}

void wc_compose(const wc_noise *s, const wc_slopes *by, long n, filter *f) {
    int nx = f->nx, both = s->nq + s->nd;
    f->nq = both;
    f->nz = s->nz;
    f->sd = s->sd;
    for (long row = 0; row < (n - 1) * nx; row++) {
        compose_row(s, by->push_before + row * by->columns, f->B + row * both);
        compose_row(s, by->push_after + row * by->columns, f->C + row * both);
    }
    for (long i = 0; i < n; i++) {
        for (int z = 0; z < s->nz; z++) {
            long from = i * by->sensors + s->which[z], to = i * s->nz + z;
            memcpy(f->H + to * nx, by->by_state + from * nx, sizeof(double) * (size_t)nx);
            compose_row(s, by->by_push + from * by->columns, f->D + to * both);
            for (int d = 0; d < s->nd; d++) f->D[to * both + s->nq + d] += s->as_reading[z * s->nd + d];
        }
    }
    compose_inputs(s, n, f);
}
