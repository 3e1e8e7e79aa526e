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
#include <math.h>
#include <string.h>

#define MOST 64 /* states, inputs and readings together */

#define AROUND 0.05     /* s, each way, of where a speed that */
#define REMEMBERS 10.0  /* fades at less than this rate, 1/s, and then */
#define FORGETS 100.0   /* at more: a chair comes to rest */
#define OFF 0.02        /* m/s, a speed's usual error */
#define STEEP 10.0      /* standard deviations of a reading, by such an error */
#define CHANGING 1.1    /* ratio of a reading's slopes about there, above which it tells nothing */

typedef struct {
    int nx, nq, nz;
    const double *A, *B, *C;  /* n-1 x nx x nx, n-1 x nx x nq, n-1 x nx x nq */
    const double *H, *D;      /* n x nz x nx, n x nz x nq */
    const double *input_sd, *input_phi; /* n x nq, n-1 x nq: standard deviation of each input, its AR(1) coefficient to the next */
    const double *sd, *phi;             /* nz, n-1 x nz: the same of each reading */
    const double *start_cov;  /* nx x nx */
    char *present;            /* n x nz: 0 in a gap */
    const double *common;     /* nq x nq: how inputs' noise at one moment is correlated; NULL: each is on its own */
} filter;

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
    double G[MOST] = {0};
    for (int r = 0; r < nx; r++) G[r] = f->C[(i * nx + r) * nq + p];
    G[nx + p] = 1;
    for (int r = 0; r < nx; r++) add_row(nx + nq, covariance * f->C[(i * nx + r) * nq + q], G, P + r * n);
    add_row(nx + nq, covariance, G, P + (nx + q) * n);
}

/* P at sample i+1 from P at i. */
static void predict(const filter *f, long i, double *P) {
    int nx = f->nx, nq = f->nq, n = nx + nq + f->nz;
    double T[MOST * MOST], U[MOST * MOST];
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

/* gain: n x nz x size, scale: n x nz, one over the standard deviation of each innovation.
 * Returns Σ log of the innovations' variances; NaN where there is no room. */
double wc_design(const filter *f, long n, double *gain, double *scale) {
    int size = f->nx + f->nq + f->nz;
    double P[MOST * MOST], Ph[MOST], total = 0;
    if (size > MOST) return NAN;
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

/* readings: n x nz, what inputs that are larger by `change` (n x nq) add to them. */
void wc_respond(const filter *f, long n, const double *change, double *readings) {
    int nx = f->nx, nq = f->nq;
    double e[MOST] = {0}, next[MOST];
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

/* signals: n x nz x m, turned into innovations in place; 0 in gaps, whatever they were.
 * start_mean: nx, of the first signal only. work: 2 * size * m doubles. */
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

/* noise: n x nq, that of the inputs as all readings have it, from their innovations (n x nz, 0 in gaps) by wc_design's gains.
 *
 * What all readings from sample i on say of s there comes back as a vector b: of s = s⁻ + P⁻ b no covariance but that of fresh
 * noise is needed, as s(i+1) = F s(i) + Q b(i+1) (Koopman 1993, "Disturbance smoother for state space models"). */
void wc_smooth(const filter *f, long n, const double *gain, const double *scale, const double *innovations, double *noise) {
    int nx = f->nx, nq = f->nq, nz = f->nz, size = nx + nq + nz;
    double b[MOST] = {0}, before[MOST];
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
        double *now = noise + i * nq, fresh_now[MOST];
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

/* scale: n x nz, one over the standard deviation of each reading, where nothing is learnt from the others. */
void wc_spread(const filter *f, long n, double *scale) {
    double P[MOST * MOST], Ph[MOST];
    begin(f, P);
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

/* Makes gaps of the readings that no slope foretells, where a chair comes to rest: if its speed is off by a little, slopes
 * make of that a deceleration of many times what friction can do. dt: s between samples; forward, sideways: the places of
 * these speeds among the states. */
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
