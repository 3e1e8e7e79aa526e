/* Derivatives of a run by its parameters, states and pushes: exact for the steps that were taken. */
#ifndef WC_TANGENT_H
#define WC_TANGENT_H

#include "advance.h"

#ifndef WC_PUSHES
#define WC_PUSHES 4 /* the first inputs are pushes, whose records may carry noise */
#endif

/* Where a record has no `bend` or `begin`, they are found by difference; without what ends in _all, only
 * parameters that start a run may be asked for. */
typedef struct {
    int columns, sensors; /* parameters that may be asked for, results that instruments read */
    int prepared;         /* numbers that `prepare` or `prepare_all` gives, at most */
    int side;             /* how many stages one call of `slopes_all` and `bend_all` takes, each number of them in a vector */
    int touches;          /* places, row * columns + column, where an equation moves with a parameter */
    const int *touched;
    const int *rows;      /* places of those results */
    const int *places;    /* of those parameters */
    wc_function motion, ramp, slopes, prepare, bend, slopes_all, prepare_all, bend_all, readout, masses, begin;
} wc_tangent;

/* What is wanted of a run, and where it goes. All matrices are stored by rows. */
typedef struct {
    int active;           /* parameters in this run */
    const int *which;     /* their columns */
    int forced;           /* does any of them enter the equations, not only the start? */
    double *transition;   /* n-1 x states x states: x(i+1) by x(i) */
    double *push_before;  /* n-1 x states x pushes: x(i+1) by the pushes at i */
    double *push_after;   /* n-1 x states x pushes: x(i+1) by the pushes at i+1 */
    double *by_state;     /* n x sensors x states: readings by x(i) */
    double *by_push;      /* n x sensors x pushes: readings by the pushes at i */
    double *start;        /* states x active: x(0) by the parameters */
    double *by_parameter; /* n x sensors x active: readings by the parameters, through everything before */
} wc_derivatives;

/* As wc_run with linear inputs, and the derivatives on the way. work: wc_tangent_work() doubles.
 * Parameters that start the run (start.*) count among the columns. */
wc_status wc_tangent_run(const wc_kernel *k, const wc_tangent *g, const double *p, double tolerance, long n,
                         const double *t, const double *w, double *x, double *y, const wc_derivatives *out,
                         double *work, long *reached);

long wc_tangent_work(const wc_kernel *k, const wc_tangent *g, int active);

#endif
