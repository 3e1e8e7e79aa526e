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
 * The filter's own state is s = (e, q, a), of size nx + nq + nz.
 */
#include "innovations.h"

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

/* to = F from, where both have m columns: F takes s from sample i to i+1, but for fresh noise. */
static inline void carry(const filter *f, long i, int m, const double *restrict from, double *restrict to) {
    int nx = f->nx, nq = f->nq;
    memset(to, 0, sizeof(double) * (size_t)((nx + nq + f->nz) * m));
    for (int r = 0; r < nx; r++) {
        for (int k = 0; k < nx; k++) add_row(m, f->A[(i * nx + r) * nx + k], from + k * m, to + r * m);
        for (int q = 0; q < nq; q++) {
            long at = (i * nx + r) * nq + q;
            add_row(m, f->B[at] + f->C[at] * f->input_phi[i * nq + q], from + (nx + q) * m, to + r * m);
        }
    }
    for (int q = 0; q < nq; q++) add_row(m, f->input_phi[i * nq + q], from + (nx + q) * m, to + (nx + q) * m);
    for (int z = nx + nq; z < nx + nq + f->nz; z++) {
        add_row(m, f->phi[i * f->nz + z - nx - nq], from + z * m, to + z * m);
    }
}

static void transpose(int n, const double *from, double *to) {
    for (int r = 0; r < n; r++) {
        for (int c = 0; c < n; c++) to[c * n + r] = from[r * n + c];
    }
}

static inline double common(const filter *f, int q, int p) { return f->common ? f->common[q * f->nq + p] : q == p; }

/* Adds to P, at sample i+1, what inputs q and p bring that have this covariance. */
static void fresh(const filter *f, long i, int q, int p, double covariance, double *P) {
    int nx = f->nx, nq = f->nq, n = nx + nq + f->nz;
    double G[WC_MOST] = {0};
    for (int r = 0; r < nx; r++) G[r] = f->C[(i * nx + r) * nq + p];
    G[nx + p] = 1;
    for (int r = 0; r < nx; r++) add_row(nx + nq, covariance * f->C[(i * nx + r) * nq + q], G, P + r * n);
    add_row(nx + nq, covariance, G, P + (nx + q) * n);
}

/* P at sample i+1 from P at i. */
static void predict(const filter *f, long i, double *P) {
    int nx = f->nx, nq = f->nq, n = nx + nq + f->nz;
    double T[WC_MOST * WC_MOST], U[WC_MOST * WC_MOST];
    carry(f, i, n, P, T);
    transpose(n, T, U);
    carry(f, i, n, U, P); /* (F P Fᵀ)ᵀ, which is symmetric */
    for (int q = 0; q < nq; q++) { /* fresh noise of the inputs at i+1 */
        for (int p = 0; p < nq; p++) {
            double factor = common(f, q, p);
            if (factor == 0) continue;
            const double *phi = f->input_phi + i * nq, *sd = f->input_sd + (i + 1) * nq;
            fresh(f, i, q, p, factor * (1 - phi[q] * phi[p]) * sd[q] * sd[p], P);
        }
    }
    for (int z = 0; z < f->nz; z++) {
        int k = nx + nq + z;
        double phi = f->phi[i * f->nz + z];
        P[k * n + k] += (1 - phi * phi) * f->sd[z] * f->sd[z];
    }
}

static void begin(const filter *f, double *P) {
    int nx = f->nx, nq = f->nq, n = nx + nq + f->nz;
    memset(P, 0, sizeof(double) * (size_t)(n * n));
    for (int r = 0; r < nx; r++) memcpy(P + r * n, f->start_cov + r * nx, sizeof(double) * (size_t)nx);
    for (int q = 0; q < nq; q++) {
        for (int p = 0; p < nq; p++) P[(nx + q) * n + nx + p] = common(f, q, p) * f->input_sd[q] * f->input_sd[p];
    }
    for (int z = 0; z < f->nz; z++) P[(nx + nq + z) * (n + 1)] = f->sd[z] * f->sd[z];
}

/* Variance of reading z at sample i, and Ph, its covariance with s. */
static double expect(const filter *f, long i, int z, const double *P, double *Ph) {
    int nx = f->nx, nq = f->nq, n = nx + nq + f->nz, own = nx + nq + z;
    const double *H = f->H + (i * f->nz + z) * nx, *D = f->D + (i * f->nz + z) * nq;
    memcpy(Ph, P + own * n, sizeof(double) * (size_t)n);
    for (int k = 0; k < nx; k++) add_row(n, H[k], P + k * n, Ph);
    for (int q = 0; q < nq; q++) add_row(n, D[q], P + (nx + q) * n, Ph);
    double variance = Ph[own];
    for (int k = 0; k < nx; k++) variance += H[k] * Ph[k];
    for (int q = 0; q < nq; q++) variance += D[q] * Ph[nx + q];
    return variance;
}

double wc_design(const filter *f, long n, double *gain, double *scale) {
    int size = f->nx + f->nq + f->nz;
    double P[WC_MOST * WC_MOST], Ph[WC_MOST], total = 0;
    if (size > WC_MOST) return NAN;
    begin(f, P);
    for (long i = 0; i < n; i++) {
        if (i) predict(f, i - 1, P);
        for (int z = 0; z < f->nz; z++) {
            double *K = gain + (i * f->nz + z) * size;
            scale[i * f->nz + z] = 0;
            if (!f->present[i * f->nz + z]) continue;
            double variance = expect(f, i, z, P, Ph);
            scale[i * f->nz + z] = 1 / sqrt(variance);
            total += log(variance);
            for (int r = 0; r < size; r++) K[r] = Ph[r] / variance;
            for (int r = 0; r < size; r++) add_row(size, -K[r], Ph, P + r * size);
        }
    }
    return total;
}

static inline void whiten(const filter *f, long n, const double *gain, const double *scale, const double *start_mean, int m,
                          double *signals, double *work) {
    int nx = f->nx, nq = f->nq, nz = f->nz, size = nx + nq + nz;
    double *S = work, *next = work + size * m;
    memset(S, 0, sizeof(double) * (size_t)(size * m));
    for (int r = 0; r < nx; r++) S[r * m] = start_mean[r];
    for (long i = 0; i < n; i++) {
        if (i) {
            carry(f, i - 1, m, S, next);
            double *kept = S;
            S = next;
            next = kept;
        }
        for (int z = 0; z < nz; z++) {
            long at = i * nz + z;
            double *signal = signals + at * m;
            if (!f->present[at]) {
                memset(signal, 0, sizeof(double) * (size_t)m);
                continue;
            }
            for (int k = 0; k < nx; k++) add_row(m, -f->H[at * nx + k], S + k * m, signal);
            for (int q = 0; q < nq; q++) add_row(m, -f->D[at * nq + q], S + (nx + q) * m, signal);
            add_row(m, -1, S + (nx + nq + z) * m, signal);
            for (int r = 0; r < size; r++) add_row(m, gain[at * size + r], signal, S + r * m);
            for (int j = 0; j < m; j++) signal[j] *= scale[at];
        }
    }
}

double wc_misfit(const filter *f, long n, const double *start_mean, const double *residual) {
    int nx = f->nx, nq = f->nq, nz = f->nz, size = nx + nq + nz;
    double P[WC_MOST * WC_MOST], Ph[WC_MOST], s[WC_MOST] = {0}, next[WC_MOST], total = 0;
    if (size > WC_MOST) return NAN;
    begin(f, P);
    memcpy(s, start_mean, sizeof(double) * (size_t)nx);
    for (long i = 0; i < n; i++) {
        if (i) {
            predict(f, i - 1, P);
            carry(f, i - 1, 1, s, next);
            memcpy(s, next, sizeof(double) * (size_t)size);
        }
        for (int z = 0; z < nz; z++) {
            long at = i * nz + z;
            if (!f->present[at]) continue;
            double variance = expect(f, i, z, P, Ph), told = residual[at] - s[nx + nq + z];
            for (int k = 0; k < nx; k++) told -= f->H[at * nx + k] * s[k];
            for (int q = 0; q < nq; q++) told -= f->D[at * nq + q] * s[nx + q];
            total += told * told / variance + log(variance);
            add_row(size, told / variance, Ph, s);
            for (int r = 0; r < size; r++) add_row(size, -Ph[r] / variance, Ph, P + r * size);
        }
    }
    return total;
}

void wc_respond(const filter *f, long n, const double *change, double *readings) {
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
        for (long at = i * f->nz; at < (i + 1) * f->nz; at++) {
            readings[at] = 0;
            for (int k = 0; k < nx; k++) readings[at] += f->H[at * nx + k] * e[k];
            for (int q = 0; q < nq; q++) readings[at] += f->D[at * nq + q] * now[q];
        }
    }
}

void wc_whiten(const filter *f, long n, const double *gain, const double *scale, const double *start_mean, int m,
               double *signals, double *work) {
    if (m == 1) whiten(f, n, gain, scale, start_mean, 1, signals, work); /* what is most asked for: compiled without loops */
    else whiten(f, n, gain, scale, start_mean, m, signals, work);
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
static void begin_undone(const filter *f, double *P) {
    int nx = f->nx, nq = f->nq, n = nx + nq + f->nz;
    for (int r = 0; r < nx; r++) {
        for (int q = 0; q < nq; q++) add_row(nq, undone(f, r, q), P + (nx + q) * n + nx, P + r * n + nx);
        for (int q = 0; q < nq; q++) P[(nx + q) * n + r] = P[r * n + nx + q];
    }
    for (int r = 0; r < nx; r++) {
        for (int q = 0; q < nq; q++) add_row(nx, undone(f, r, q), P + (nx + q) * n, P + r * n);
    }
}

void wc_spread(const filter *f, long n, double *scale) {
    double P[WC_MOST * WC_MOST], Ph[WC_MOST];
    begin(f, P);
    if (n > 1) begin_undone(f, P);
    for (long i = 0; i < n; i++) {
        if (i) predict(f, i - 1, P);
        for (int z = 0; z < f->nz; z++) scale[i * f->nz + z] = 1 / sqrt(expect(f, i, z, P, Ph));
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
            f->input_sd[i * both + q] = q < nq ? at_row(s, n, i, q) : s->unknown_sd[q - nq];
            if (i + 1 < n)
                f->input_phi[i * both + q] = q < nq ? over(s->push_ar[q], gap, s->push_step[q]) : exp(-gap / s->lasting[q - nq]);
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
        }
    }
    compose_inputs(s, n, f);
}
