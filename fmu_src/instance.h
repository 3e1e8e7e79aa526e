/* One simulated instance, whatever the protocol: its phases, values, checks, steps and saved states.
 *
 * fmi2.c and fmi3.c translate calls to these functions. Every one that can refuse says why through the
 * instance's log, in one sentence, and leaves the instance as it was. All are static, because all.c includes every file.
 *
 *     values.c        log, phases, variables by value reference
 *     motion.c        steps of Co-Simulation, evaluations of Model Exchange
 *     derivatives.c   directional and adjoint derivatives, output derivatives, slopes of inputs
 *     saved.c         states as values and as bytes
 */
#ifndef WC_INSTANCE_H
#define WC_INSTANCE_H

#include <stddef.h>
#include <stdint.h>

#include "model.h"

/* The numbers are those of fmi2Status and fmi3Status. */
typedef enum { WC_DONE = 0, WC_DISCARDED = 2, WC_FAILED = 3 } wc_result;
typedef enum { WC_LOG_WARNING = 1, WC_LOG_DISCARD = 2, WC_LOG_ERROR = 4, WC_LOG_MODEL = 8 } wc_category;
typedef enum { WC_COSIMULATION = 1, WC_MODEL_EXCHANGE = 2 } wc_interface;

typedef enum {
    WC_INSTANTIATED = 1,
    WC_INITIALIZING = 2,
    WC_STEPPING = 4, /* Co-Simulation */
    WC_BETWEEN = 8,  /* Co-Simulation, while the importer is told of an internal step */
    WC_EVENT = 16,   /* Model Exchange */
    WC_CONTINUOUS = 32,
    WC_TERMINATED = 64
} wc_phase;
#define WC_ANY_PHASE 127
#define WC_FOR_COSIMULATION 128 /* beside phases: legal in this interface only */
#define WC_FOR_EXCHANGE 256
#define WC_EVALUATION (WC_INITIALIZING | WC_EVENT | WC_CONTINUOUS | WC_TERMINATED | WC_FOR_EXCHANGE)
#define WC_RUNNING (WC_STEPPING | WC_EVENT | WC_CONTINUOUS)
#define WC_BEFORE_END (WC_INSTANTIATED | WC_INITIALIZING | WC_RUNNING)

/* Tells the importer: the numeric status is FMI's. */
typedef void (*wc_logger)(void *host, int status, const char *category, const char *text);

/* Called after each internal step of Co-Simulation with the time reached; may bring *end forward, never back. */
typedef void (*wc_pause)(void *host, double time, double *end);

/* The last letter is the version of the layout below. Earlier ones began with the magic itself. */
#define WC_MAGIC "wcstate3"
#define WC_MAGIC_OF_ANY_VERSION 7 /* letters */

#define WC_LEAST_TOLERANCE 1e-12
#define WC_MOST_TOLERANCE 1e-3
#define WC_LONGEST 1e12 /* s from the start, as far as a grid of milliseconds can be counted */

/* All that a saved state must hold: no pointers and no padding, so that its bytes outlive a process. */
typedef struct {
    uint64_t nothing; /* zero: an importer that mistakes a state for the place of its address finds none */
    char magic[8], token[40];
    uint64_t checksum;
    double tolerance, start_time, stop_time, time;
    double elapsed, lost; /* since start_time, a compensated sum: steps add up exactly, whatever the start */
    double x[WC_MAX_STATES], w[WC_MAX_INPUTS], p[WC_MAX_PARAMETERS];
    double slope[WC_MAX_INPUTS], last_slope[WC_MAX_INPUTS]; /* of the inputs over the next step, and the last */
    double held[WC_MAX_CROSSINGS];                          /* what is true or false, as of the last event */
    int32_t interface, phase, has_stop;
    int32_t restart; /* x follows from start values that have changed since */
    int32_t stale;   /* a jump has left the algebraic rows of x where they were */
    int32_t jumped;  /* an event has changed a continuous state, and the importer does not know yet */
} wc_saved;

typedef struct {
    wc_saved now;
    double y[WC_MAX_OUTPUTS], rate[WC_MAX_STATES], z[WC_MAX_CROSSINGS];
    int y_valid, rate_valid; /* rate and z */
    unsigned warned;         /* bit i: watch i has spoken, and after these each idle input */
    uint32_t clamped;        /* bit i: it has been said that input i was beyond a bound */
    unsigned categories;     /* of the log, switched on */
    const char *standard;    /* what the protocol's functions begin with */
    wc_logger log;
    wc_pause pause; /* or 0 */
    void *host;
} wc_instance;

/* ---- values.c ---- */

/* Why this instance cannot be made, or 0. */
static const char *wc_refuse_instance(const char *name, wc_interface interface, const char *token);

/* After standard, log and host have been set. */
static void wc_begin(wc_instance *c, wc_interface interface, int logging);

/* Gives the memory of an instance, which calloc gave, back. Where that stays in the process, later calls find no instance there
 * and fail. */
static void wc_end(void *instance);

/* The instance, or 0 where there is none. */
static wc_instance *wc_alive(void *instance);

/* As after wc_begin; what belongs to the host stays. */
static void wc_reset(wc_instance *c);

/* One sentence to the log. */
static void wc_say(const wc_instance *c, wc_category category, const char *format, ...)
#ifdef __GNUC__
    __attribute__((format(printf, 3, 4)))
#endif
    ;

/* Switches categories of the log, all where n is 0. */
static wc_result wc_set_logging(wc_instance *c, const char *function, int on, size_t n, const char *const names[]);

/* The instance, where the call is legal in its phase; else 0, and a sentence that names the legal ones. */
static wc_instance *wc_enter(void *instance, const char *function, int legal);

/* Where an argument that must not be null is null: a sentence. */
static wc_result wc_missing(const wc_instance *c, const char *function, const char *argument);

/* A function that this FMU has no use for: a sentence that says why. */
static wc_result wc_unsupported(void *instance, const char *function, const char *why);

/* The kernel that the parameters choose, and its place among all. */
static int wc_law_of(const wc_instance *c);
static const wc_kernel *wc_kernel_of(const wc_instance *c);
static const wc_kernel *wc_kernel_by(const double *p);

/* The variable with this value reference and type; 0, with a sentence, where there is none. */
static const wc_variable *wc_find(const wc_instance *c, const char *function, unsigned reference, wc_type type);

/* Arrays of values as the protocols know them. */
typedef enum { WC_DOUBLES, WC_INTS, WC_INT64S, WC_BYTES } wc_array;

/* The value that an input takes: itself, or the bound that it is beyond. Says, once for each input, where more is cut off than
 * rounding. */
static double wc_within(wc_instance *c, const wc_variable *v, double value);

/* Whether a parameter or an input can have this value. */
static int wc_possible(const wc_variable *v, double value);

/* Whether the model has, with these parameters, the continuous states that its description lists. */
static int wc_same_states(const wc_kernel *k, const double *p);

/* Gives n variables their values, all or none. */
static wc_result wc_set_all(wc_instance *c, const char *function, const unsigned vr[], size_t n, wc_type type,
                            const void *values, wc_array array);
static wc_result wc_get_all(wc_instance *c, const char *function, const unsigned vr[], size_t n, wc_type type,
                            void *values, wc_array array);

/* Numbers the same way on every platform, and values as a reader knows them, with unit or name. */
typedef struct {
    char text[64];
} wc_label;
static wc_label wc_number(double value);
static wc_label wc_valued(const wc_variable *v, double value);

/* ---- motion.c ---- */

static wc_result wc_set_up(wc_instance *c, const char *function, int has_tolerance, double tolerance, double start,
                           int has_stop, double stop);
static wc_result wc_leave_initialization(wc_instance *c, const char *function);

/* Brings states up to date with start values and jumps. */
static wc_result wc_settle(wc_instance *c, const char *function);

/* Outputs, rates and crossings, where they are not up to date. */
static wc_result wc_refresh_outputs(wc_instance *c, const char *function);
static wc_result wc_refresh_rates(wc_instance *c, const char *function);

/* One communication step of length h, or as far as the pause lets it. */
static wc_result wc_do_step(wc_instance *c, const char *function, double point, double h);

/* Model Exchange. Arrays must have the model's number of states, or of crossings. */
static wc_result wc_set_time(wc_instance *c, const char *function, double time);
static wc_result wc_set_states(wc_instance *c, const char *function, const double *x, size_t n);
static wc_result wc_get_states(wc_instance *c, const char *function, double *x, size_t n);
static wc_result wc_get_rates(wc_instance *c, const char *function, double *rate, size_t n);
static wc_result wc_get_nominals(wc_instance *c, const char *function, double *nominal, size_t n);
static wc_result wc_get_crossings(wc_instance *c, const char *function, double *z, size_t n);
static wc_result wc_enter_continuous(wc_instance *c, const char *function);
static wc_result wc_complete_step(wc_instance *c, const char *function);

/* Model Exchange, in an event: whether continuous states have jumped, told once. */
static wc_result wc_update_discrete(wc_instance *c, const char *function, int *jumped);

/* ---- derivatives.c ---- */

/* out = Σ ∂unknown/∂known · seed, as long as unknown. */
static wc_result wc_directional(wc_instance *c, const char *function, const unsigned unknown[], size_t n_unknown,
                                const unsigned known[], size_t n_known, const double seed[], double out[]);

/* out = Σ seed · ∂unknown/∂known, as long as known. */
static wc_result wc_adjoint(wc_instance *c, const char *function, const unsigned unknown[], size_t n_unknown,
                            const unsigned known[], size_t n_known, const double seed[], double out[]);

/* First derivatives of outputs by time, at the end of a step. */
static wc_result wc_output_slopes(wc_instance *c, const char *function, const unsigned vr[], size_t n,
                                  const int order[], double out[]);

/* First derivatives of inputs over the next step. */
static wc_result wc_input_slopes(wc_instance *c, const char *function, const unsigned vr[], size_t n, const int order[],
                                 const double value[]);

/* ---- saved.c ---- */

static wc_result wc_get_state(wc_instance *c, const char *function, void **state);
static wc_result wc_set_state(wc_instance *c, const char *function, const void *state);
static wc_result wc_free_state(void **state);
static wc_result wc_state_size(wc_instance *c, const char *function, const void *state, size_t *size);
static wc_result wc_serialize(wc_instance *c, const char *function, const void *state, void *bytes, size_t size);
static wc_result wc_deserialize(wc_instance *c, const char *function, const void *bytes, size_t size, void **state);

#endif
