/* Whitening by a Kalman filter; see innovations.c. */
#ifndef WC_INNOVATIONS_H
#define WC_INNOVATIONS_H

#define WC_MOST 64 /* states, inputs and readings together */

typedef struct {
    int nx, nq, nz;
    const double *A;          /* n-1 x nx x nx */
    double *B, *C;            /* n-1 x nx x nq */
    double *H, *D;            /* n x nz x nx, n x nz x nq */
    double *input_sd, *input_phi; /* n x nq, n-1 x nq: standard deviation of each input, its AR(1) coefficient to the next */
    const double *sd;             /* nz: the same of each reading, */
    double *phi;                  /* n-1 x nz */
    const double *start_cov;  /* nx x nx */
    char *present;            /* n x nz: 0 in a gap */
    double *common;           /* nq x nq: how inputs' noise at one moment is correlated; NULL: each is on its own */
} filter;

/* What is known of the noise of a run: of nq recorded pushes, whose columns among all are `pushes`, of nz readings, which are
 * `which` of all, and of nd forces that nobody recorded. The inputs of the filter are the former, then the latter. */
typedef struct {
    int nq, nz, nd;
    const double *time;                            /* n */
    const int *pushes, *which;
    const double *push_sd, *push_ar, *push_step;   /* nq: standard deviation, AR(1) coefficient from one sample to the next, */
    const double *sd, *ar, *step;                  /* nz: and s between these samples */
    const double *unknown_sd, *lasting;            /* n x nd: standard deviation at each moment, and s until forgotten, */
    const double *together;                        /* nd x nd: correlation */
    const double *as_push;                         /* nq x nd: as what change of the pushes one unit of each acts, */
    const double *as_reading;                      /* nz x nd: and what it adds to a reading besides what it does to the chair */
} wc_noise;

/* How a run goes with its states and pushes, as in tangent.h; all of its `columns` pushes and `sensors` readings. */
typedef struct {
    int columns, sensors;
    const double *push_before, *push_after, *by_state, *by_push;
} wc_slopes;

/* Fills in what a filter of nx states has of its inputs and readings: B, C, H, D, input_sd, input_phi, phi, common. */
void wc_compose(const wc_noise *s, const wc_slopes *by, long n, filter *f);

/* gain: n x nz x size, scale: n x nz, one over the standard deviation of each innovation.
 * Returns Σ log of the innovations' variances; NaN where there is no room. */
double wc_design(const filter *f, long n, double *gain, double *scale);

/* signals: n x nz x m, turned into innovations in place; 0 in gaps, whatever they were.
 * start_mean: nx, of the first signal only. */
void wc_whiten(const filter *f, long n, const double *gain, const double *scale, const double *start_mean, int m,
               double *signals);

/* −2 log likelihood, but for a constant, of one signal (n x nz): Σ of squares of its innovations, and of log of their variances.
 * NaN where there is no room. */
double wc_deviance(const filter *f, long n, const double *start_mean, const double *residual);

/* readings: n x nz, and states: n x nx, or 0: what inputs that are larger by `change` (n x nq) add to them. */
void wc_respond(const filter *f, long n, const double *change, double *states, double *readings);

/* noise: n x nq, that of the inputs as all readings have it, from their innovations (n x nz, 0 in gaps) by wc_design's gains. */
void wc_smooth(const filter *f, long n, const double *gain, const double *scale, const double *innovations, double *noise);

/* scale: n x nz, one over the standard deviation of each reading, where nothing is learnt from the others. Inputs that one noise
 * drives together have no mean, and the start is that of a simulation to which they add nothing. */
void wc_spread(const filter *f, long n, double *scale);

/* Makes gaps of the readings that no slope foretells, where a chair comes to rest: if its speed is off by a little, slopes
 * make of that a deceleration of many times what friction can do. dt: s between samples; forward, sideways: the places of
 * these speeds among the states. */
void wc_drop_kinks(const filter *f, long n, double dt, int forward, int sideways);

#endif
