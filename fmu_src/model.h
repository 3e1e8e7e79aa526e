/* The seam between generated physics and hand-written protocol.
 *
 * The generated model_data.c defines `model`: the table of variables, the kernels, and the few rules that
 * tie them together. All other files here read nothing else of the physics. They are parts of one file to compile,
 * all.c, which includes the generated ones first.
 */
#ifndef WC_MODEL_H
#define WC_MODEL_H

#include "advance.h"

#define WC_MAX_PARAMETERS 256
#define WC_MAX_OUTPUTS 128
#define WC_MAX_CROSSINGS 8

typedef enum { WC_TIME, WC_PARAMETER, WC_INPUT, WC_OUTPUT, WC_DERIVATIVE, WC_INDICATOR } wc_kind;
typedef enum { WC_REAL, WC_ENUMERATION, WC_BOOLEAN } wc_type;

/* One variable; its value reference is its place in the table. */
typedef struct {
    const char *name, *unit;
    wc_kind kind;
    wc_type type;
    int index; /* into the parameters, inputs, outputs, states or crossings of a kernel */
    int fixed; /* a parameter that may not change once the simulation has started */
    double start, min, max;
    const char *const *choices; /* of an enumeration, whose values count from 1; else 0 */
} wc_variable;

/* While parameter `mode` has the value `when`, state `state` takes every new value of `parameter`. */
typedef struct {
    int parameter, mode;
    double when;
    int state;
} wc_jump;

/* Beyond ±limits[law] of one of `count` outputs, the model no longer holds; not looked at while
 * output `guard` (< 0: none) lies within ±guard_limit. */
typedef struct {
    int variable, count; /* the first variable's value reference */
    const double *limits;
    int guard;
    double guard_limit;
    const char *meaning; /* the rest of the sentence that begins with the variable's value */
} wc_watch;

/* An input that does nothing while a parameter is 0, by their value references. */
typedef struct {
    int input, parameter;
} wc_idle;

/* A state that is integrated, by the model itself in Co-Simulation, by the importer in Model Exchange. The other
 * states of a kernel are solutions of algebraic rows. */
typedef struct {
    int place;    /* among the kernel's states */
    int variable; /* the value reference under which it is an output */
    double nominal;
} wc_state;

typedef struct {
    const char *name, *token; /* the token (FMI 2: guid) changes with everything that changes results */
    int variables;
    const wc_variable *variable;
    const wc_kernel *const *kernels; /* of the same size; parameter `law` (from 1, within its bounds) chooses */
    int law;                         /* < 0: there is one kernel, and nothing to choose */
    wc_function start_forward; /* (p, w, dp, dw) → dx at the start */
    int jumps;
    const wc_jump *jump;
    int watches;
    const wc_watch *watch;
    int idles;
    const wc_idle *idle;
    double tolerance, grid; /* of the internal steps, unless the importer asks for another tolerance */
    int states; /* 0: this model is for Co-Simulation only */
    const wc_state *state;
    int crossings;
    const int *crossing; /* the outputs, true or false, that switch where the kernel's z crosses zero */
} wc_model;

#endif
