/* One run against its readings: simulated, linearised, filtered, started where its readings want it, and its errors. For
 * Python and for the report's page.
 *
 * All memory is the caller's: wc_evaluation_room() says how much. In the records that a caller fills in are nothing but
 * pointers and whole numbers, which in a page are words of one size. */
#ifndef WC_EVALUATION_H
#define WC_EVALUATION_H

#include "innovations.h"
#include "tangent.h"

/* Beside those of wc_status: more than WC_MOST states, inputs and readings, or uncertain constants; and what a constant does
 * grows beyond all numbers. */
enum { WC_TOO_MANY = 4, WC_UNBOUNDED = 5 };

typedef enum { WC_CLOCK = 0, WC_BASELINE = 1 } wc_constant;

/* What one recording is, whatever the model's values are. */
typedef struct {
    const wc_kernel *kernel;
    const wc_tangent *tangent;
    long n;
    const double *time, *inputs; /* n, n x inputs: as recorded */
    const double *recorded;      /* n x nz: readings, NaN in gaps */
    const int *late;             /* inputs: 1 for those that a delay of the record of pushes moves */
    const int *drifts;           /* nz: 1 where noise adds up without end */
    const double *usual;         /* 1: s between samples */
    int speeds[2];               /* places of u and v among the states */
    wc_noise noise;              /* whose as_push is for a chair of the mass that forces were found for */

    int active, forced;          /* derivatives by parameters: how many, do any of them enter the equations, */
    const int *columns;          /* and which these are; those that start the run are the last */
    int starts;                  /* parameters that start the run: */
    const int *start_places;     /* their places among the model's, */
    const int *start_set;        /* 1 where the run itself sets it */
    int forward;                 /* which of them is the speed */
    const double *start_prior, *start_sd;

    int constants;               /* what else is uncertain of this run: clocks, and baselines of pushes: */
    const int *constant_kind;    /* each a wc_constant, */
    const int *constant_inputs;  /* constants x inputs, constants x nz: 1 for what belongs to it, */
    const int *constant_readings;
    const double *constant_shape; /* constants x n: of a baseline, */
    const double *constant_sd;

    int leads; /* is the run led along the forces that nobody recorded? */
} wc_recording;

/* The values of a model. */
typedef struct {
    const double *p;       /* parameters; those that start the run are the evaluation's */
    const double *offsets; /* nz: of the sensors */
    const double *numbers; /* WC_TOLERANCE … WC_MASS */
} wc_values;

enum {
    WC_TOLERANCE, /* of the simulation */
    WC_DELAY,     /* s by which the record of pushes is early */
    WC_ALONG,     /* times the forces along the heading that act on a chair of this mass */
    WC_MASS,      /* kg */
    WC_NUMBERS
};

/* What a simulation says of a run. */
typedef struct {
    double *start;     /* starts + constants */
    double *results;   /* n x outputs */
    double *predicted; /* n x nz: readings */
    double *foretold;  /* n x nz: the same by slopes about where forces that nobody recorded, or errors of pushes, lead the run */
    double *r;         /* n x nz: innovations, NaN in gaps */
} wc_simulated;

/* A run linearised where its readings want it. */
typedef struct {
    wc_simulated own;
    double *path;        /* n x nd: forces along which it is led */
    double *told;        /* 2: Σ log of the innovations' variances; and of what constants add to it */
    double *spread;      /* n x nz: see wc_spread */
    double *measured;    /* n x nz: readings less offsets */
    double *added;       /* n x nz: what the forces, and errors of the pushes, add to the readings */
    wc_derivatives by;
    filter f;
    double *gain, *scale;
    double *offset;      /* states + constants: where the true ones are expected, less the simulated ones */
    double *by_start;    /* n x nz x (starts + constants): readings by these */
    double *slopes;      /* the same: innovations by these */
    double *constant;    /* n x nz x constants: innovations by each, in its standard deviations; */
    double *less;        /* constants x constants: takes them out, see `marginal` */
    double *as_push;     /* nq x nd */
    /* good until the next evaluation in the same place: */
    double *x, *y;       /* n x states, n x outputs */
    double *driven;      /* n x nz: readings as led */
    double *p, *w, *column, *busy, *innovations, *added_again, *before, *step, *noise, *none;
    double *errors, *trial; /* n x nq: of the pushes, beside forces that lead the run */
    long *reached;
    const double *pushed; /* n x nq, the caller's: by how much pushes were larger than their record; or 0 */
    const char *silent;   /* n x nz, the caller's: 1 for a reading that is not asked; or 0 */
} wc_evaluation;

/* rooms[0]: how many doubles an evaluation keeps, as long as somebody asks for the run again by its filter; rooms[1]: and how
 * many it works with, which several may share. Where blocks of so many are given, the record points into them; and to no errors
 * of the pushes. */
void wc_evaluation_room(const wc_recording *s, wc_evaluation *e, double *kept, double *work, long *rooms);

/* The same for what wc_again() writes. */
long wc_simulated_room(const wc_recording *s, wc_simulated *to, double *block);

/* Where a run is expected to start before its readings are asked, on no path. */
void wc_expected(const wc_recording *s, wc_evaluation *e);

/* From e->own.start along e->path, with e->pushed. `rounds`: how often at most the start is moved to where the readings want it; a
 * run that is led stays on its path if that is 0, and else goes to where forces lead it. On failure e->reached says how far it
 * came. */
int wc_evaluate(const wc_recording *s, const wc_values *v, wc_evaluation *e, int rounds);

/* Where casters may swing round, after wc_evaluate(): on to where errors of the pushes lead the run, by as many steps as slopes do
 * not hold for. errors: n x nq, which e->pushed then is, if any step is taken. work: wc_pushes_room() doubles. */
int wc_follow_pushes(const wc_recording *s, const wc_values *v, wc_evaluation *e, double *errors, double *work);
long wc_pushes_room(const wc_recording *s);

/* Fills in e->spread, of an evaluation that is the last in its place of work. */
void wc_find_spread(const wc_recording *s, wc_evaluation *e);

/* The same run at other values by the filter of e, a better start to first order. `kept`: its start is kept, and what the forces
 * add. x: n x states. */
int wc_again(const wc_recording *s, const wc_values *v, wc_evaluation *e, int kept, double *x, wc_simulated *to);

/* errors: n x nz, measured less foretold, in standard deviations, NaN in gaps. A reading varies with its sensor's noise and with
 * that of the pushes, added up. Where that adds up without end a run has one error rather than as many as samples: there stands
 * what each reading says that was not known from those before it.
 * sums: nz x 3, squares of errors, how many there are, and squares of measured less predicted. */
void wc_errors(const wc_recording *s, const wc_values *v, const wc_evaluation *e, const wc_simulated *of, double *errors,
               double *sums);

/* Readings as the sensors give them, with their offsets. */
void wc_as_read(const wc_recording *s, const wc_values *v, const double *predicted, double *to);

/* Innovations by k values, at most WC_MOST, from those where each is `steps` larger (k x n x nz) and those of e, as normal
 * equations: k x k, k, and the sum of e's squares. */
void wc_normal(const wc_recording *s, const wc_evaluation *e, int k, const double *steps, const double *moved, double *jtj,
               double *jtr, double *squares);

/* variance: n x nz, that readings `base` have because k values have a covariance (k x k), from what they are where each of these
 * is `steps` larger (k x n x nz). */
void wc_doubt(const wc_recording *s, int k, const double *base, const double *steps, const double *moved,
              const double *covariance, double *variance);

#endif
