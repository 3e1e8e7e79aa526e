/* Whitening by a Kalman filter: what is new in each reading, in units of its own uncertainty.
 *
 * Deviations from a simulated run obey
 *     e(i+1) = A(i) e(i) + B(i) q(i) + C(i) q(i+1),    z(i) = H(i) e(i) + D(i) q(i) + a(i),
 * with q the noise of the recorded inputs, white over samples, and a the noise of the readings, one
 * AR(1) process each. The filter turns z into independent innovations of variance 1; being linear it
 * does the same to any signal that may hide in z, so residuals and sensitivities go through together.
 */
#include <math.h>
#include <string.h>

#define MOST 64 /* states, inputs and readings together */

typedef struct {
    int nx, nq, nz, m;        /* states, noisy inputs, readings, signals to whiten */
    const double *A, *B, *C;  /* n-1 x nx x nx, n-1 x nx x nq, n-1 x nx x nq */
    const double *H, *D;      /* n x nz x nx, n x nz x nq */
    const double *input_sd;   /* nq */
    const double *sd, *phi;   /* nz: standard deviation and AR(1) coefficient of each reading */
    const double *start_cov;  /* nx x nx */
    const double *start_mean; /* nx: of the first signal only */
    int blind;                /* learn nothing from the readings: then only variances are right, not their independence */
} filter;

static void predict(const filter *f, long i, int n, double *P, double *S) {
    int nx = f->nx, nq = f->nq, m = f->m;
    double F[MOST * MOST], T[MOST * MOST];
    memset(F, 0, sizeof F);
    for (int r = 0; r < nx; r++) {
        memcpy(F + r * n, f->A + (i * nx + r) * nx, sizeof(double) * (size_t)nx);
        memcpy(F + r * n + nx, f->B + (i * nx + r) * nq, sizeof(double) * (size_t)nq);
    }
    for (int z = 0; z < f->nz; z++) F[(nx + nq + z) * n + nx + nq + z] = f->phi[z];
    for (int r = 0; r < n; r++) { /* T = F P and F S, row by row; inputs' rows are empty */
        double row[MOST] = {0};
        for (int k = 0; k < n; k++) {
            double factor = F[r * n + k];
            for (int c = 0; factor != 0 && c < n; c++) row[c] += factor * P[k * n + c];
        }
        memcpy(T + r * n, row, sizeof(double) * (size_t)n);
    }
    for (int r = 0; r < n; r++) {
        for (int c = 0; c < n; c++) {
            double sum = 0;
            for (int k = 0; k < n; k++) sum += T[r * n + k] * F[c * n + k];
            P[r * n + c] = sum;
        }
    }
    for (int q = 0; q < nq; q++) { /* fresh noise of the inputs at i+1 */
        double G[MOST] = {0}, variance = f->input_sd[q] * f->input_sd[q];
        for (int r = 0; r < nx; r++) G[r] = f->C[(i * nx + r) * nq + q];
        G[nx + q] = 1;
        for (int r = 0; r < n; r++) {
            for (int c = 0; c < n; c++) P[r * n + c] += G[r] * variance * G[c];
        }
    }
    for (int z = 0; z < f->nz; z++) {
        int k = nx + nq + z;
        P[k * n + k] += (1 - f->phi[z] * f->phi[z]) * f->sd[z] * f->sd[z];
    }
    double next[MOST]; /* signal by signal, S is n x m */
    for (int j = 0; j < m; j++) {
        for (int r = 0; r < n; r++) {
            double sum = 0;
            for (int k = 0; k < n; k++) sum += F[r * n + k] * S[k * m + j];
            next[r] = sum;
        }
        for (int r = 0; r < n; r++) S[r * m + j] = next[r];
    }
}

/* signals: n x nz x m, turned into innovations in place; NaN in the first signal marks a gap, left NaN.
 * work: MOST * m doubles. Returns Σ log of the innovations' variances. */
double wc_innovations(const filter *f, long n, double *signals, double *work) {
    int nx = f->nx, nq = f->nq, nz = f->nz, m = f->m, size = nx + nq + nz;
    double P[MOST * MOST], *S = work, total = 0;
    if (size > MOST) return NAN;
    memset(P, 0, sizeof P);
    memset(S, 0, sizeof(double) * (size_t)(size * m));
    for (int r = 0; r < nx; r++) {
        memcpy(P + r * size, f->start_cov + r * nx, sizeof(double) * (size_t)nx);
        S[r * m] = f->start_mean[r];
    }
    for (int q = 0; q < nq; q++) P[(nx + q) * (size + 1)] = f->input_sd[q] * f->input_sd[q];
    for (int z = 0; z < nz; z++) P[(nx + nq + z) * (size + 1)] = f->sd[z] * f->sd[z];
    for (long i = 0; i < n; i++) {
        if (i) predict(f, i - 1, size, P, S);
        for (int z = 0; z < nz; z++) {
            double h[MOST] = {0}, Ph[MOST], variance = 0, *signal = signals + (i * nz + z) * m;
            if (isnan(signal[0])) continue;
            memcpy(h, f->H + (i * nz + z) * nx, sizeof(double) * (size_t)nx);
            memcpy(h + nx, f->D + (i * nz + z) * nq, sizeof(double) * (size_t)nq);
            h[nx + nq + z] = 1;
            for (int r = 0; r < size; r++) {
                double sum = 0;
                for (int c = 0; c < size; c++) sum += P[r * size + c] * h[c];
                Ph[r] = sum;
            }
            for (int r = 0; r < size; r++) variance += h[r] * Ph[r];
            double inverse = 1 / variance, scale = sqrt(inverse);
            total += log(variance);
            for (int r = 0; r < size; r++) {
                if (h[r] == 0) continue;
                for (int j = 0; j < m; j++) signal[j] -= h[r] * S[r * m + j];
            }
            for (int r = 0; r < size && !f->blind; r++) {
                double gain = Ph[r] * inverse;
                for (int j = 0; j < m; j++) S[r * m + j] += gain * signal[j];
                for (int c = 0; c < size; c++) P[r * size + c] -= gain * Ph[c];
            }
            for (int j = 0; j < m; j++) signal[j] *= scale;
        }
    }
    return total;
}
