/* The one way a wheelchair moves through time: for FMUs, Python and the report page.
 *
 * A kernel is one generated model: its sizes and its functions, in CasADi's calling convention. All
 * memory is on the stack; nothing is allocated, nothing is global, so any number of threads may run.
 */
#ifndef WC_ADVANCE_H
#define WC_ADVANCE_H

/* Before what is shared between files. Where all of them are included in one, as in the FMU, it says `static`, and
 * nothing but FMI's own functions is seen outside. */
#ifndef WC_LOCAL
#define WC_LOCAL
#endif

#define WC_MAX_STATES 32
#define WC_MAX_INPUTS 32

typedef int (*wc_function)(const double **arg, double **res, long long *iw, double *w, int mem);

typedef struct {
    int states, inputs, parameters, outputs;
    const double *nominal; /* the size of each state, against which errors are measured */
    int seldom; /* how many inputs most runs leave at rest, which they are, and where they rest */
    const int *seldom_inputs;
    const double *resting;
    int switches; /* how many parameters put effects on, and which they are */
    const int *switch_parameters;
    /* `plain`, where given: a step while those inputs rest; `bare` and `bare_output`: and while no effect is on */
    wc_function start, project, step, plain, bare, output, bare_output, forward, rate, mass;
} wc_kernel;

typedef enum {
    WC_OK = 0,
    WC_NOT_FINITE = 1,    /* the model's equations gave NaN or infinity */
    WC_STEP_TOO_SMALL = 2, /* the error test failed at every step down to WC_SHORTEST, or wc_most_tries were not enough */
    WC_NOT_CONSISTENT = 3  /* Newton's method did not put the algebraic rows right */
} wc_status;

typedef struct {
    double tolerance; /* of each step, relative to nominal + |x| */
    double grid;      /* > 0: no step crosses a multiple of this, and none remembers the last; where a whole cell is no step
                         * within the tolerance, algebraic rows are put right at its end and not tested on the way */
} wc_accuracy;

/* Steps that may be tried in a stretch of this length (s). No chair needs as many; without a limit, parameters that ask for
 * steps of a nanosecond would keep whoever called for hours. */
static inline double wc_most_tries(double length) { return 2000 + 5e5 * length; }

/* States at the start for parameters p and inputs w, algebraic ones in place. */
WC_LOCAL wc_status wc_start(const wc_kernel *k, const double *p, const double *w, double *x);

/* Puts the algebraic rows right after a jump of inputs, parameters or states; others stay. */
WC_LOCAL wc_status wc_project(const wc_kernel *k, const double *p, const double *w, double *x);

/* From t0 to t1 while the inputs go linearly from w0 to w1. On failure x is as it was at t0.
 * steps, where given, grows by the number of accepted steps. */
WC_LOCAL wc_status wc_advance(const wc_kernel *k, const double *p, wc_accuracy accuracy, double t0, double t1,
                              const double *w0, const double *w1, double *x, long *steps);

/* A whole run: inputs w (n rows) at times t (n), states x (n rows, the first given), results y (n rows).
 * hold: inputs keep each row's value until the next time, instead of going there linearly.
 * *reached is the number of rows done, n where all went well. */
WC_LOCAL wc_status wc_run(const wc_kernel *k, const double *p, wc_accuracy accuracy, long n, const double *t,
                          const double *w, int hold, double *x, double *y, long *reached, long *steps);

WC_LOCAL void wc_output(const wc_kernel *k, const double *p, const double *w, const double *x, double *y);

#endif
