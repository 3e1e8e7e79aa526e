/* One simulated chair, whatever the protocol: its values, their checks, its steps and saved states.
 *
 * Every function that can refuse says why through the instance's `log`, in one sentence, and leaves
 * the instance as it was.
 */
#ifndef WC_INSTANCE_H
#define WC_INSTANCE_H

#include <stddef.h>
#include <stdint.h>

#include "model.h"

typedef enum { WC_DONE, WC_DISCARDED, WC_FAILED } wc_result;
typedef enum { WC_LOG_WARNING = 1, WC_LOG_DISCARD = 2, WC_LOG_ERROR = 4, WC_LOG_MODEL = 8 } wc_category;
typedef enum { WC_INSTANTIATED = 1, WC_INITIALIZING = 2, WC_STEPPING = 4, WC_TERMINATED = 8 } wc_phase;

typedef void (*wc_logger)(void *host, wc_category category, const char *text);

/* All that a saved state must hold: no pointers and no padding, so that its bytes outlive a process. */
typedef struct {
    char magic[8], token[40];
    uint64_t checksum;
    double tolerance, start_time, stop_time, time;
    double elapsed, lost; /* since start_time, a compensated sum: steps add up exactly, whatever the start */
    double x[WC_MAX_STATES], w[WC_MAX_INPUTS], slope[WC_MAX_INPUTS], p[WC_MAX_PARAMETERS];
    int32_t phase, has_stop;
    int32_t restart; /* x follows from start values that have changed since */
    int32_t stale;   /* a jump has left the algebraic rows of x where they were */
} wc_saved;

typedef struct {
    wc_saved now;
    double y[WC_MAX_OUTPUTS];
    int y_valid;
    unsigned warned; /* bit i: watch i has spoken */
    wc_logger log;
    void *host;
} wc_instance;

/* As after instantiation; keeps log and host. */
void wc_reset(wc_instance *c);

/* One sentence to the log. */
void wc_say(const wc_instance *c, wc_category category, const char *format, ...)
#ifdef __GNUC__
    __attribute__((format(printf, 3, 4)))
#endif
    ;

/* The kernel that the parameters choose. */
const wc_kernel *wc_kernel_of(const wc_instance *c);

/* The variable with this value reference and type; 0, with a sentence, where there is none. */
const wc_variable *wc_find(const wc_instance *c, const char *function, unsigned reference, wc_type type);

/* A value, after bringing what it depends on up to date. */
wc_result wc_get(wc_instance *c, const wc_variable *v, double *value);

/* May this variable be given this value now? Says why not. */
wc_result wc_check(const wc_instance *c, const char *function, const wc_variable *v, double value);

/* Gives a checked value. */
void wc_set(wc_instance *c, const wc_variable *v, double value);

/* Brings states up to date with start values and jumps. */
wc_result wc_settle(wc_instance *c, const char *function);

/* One communication step of length h. */
wc_result wc_do_step(wc_instance *c, const char *function, double point, double h);

/* dy along changes of inputs and parameters, given by variable. */
wc_result wc_directional(wc_instance *c, const char *function, const double *dw, const double *dp, double *dy);

/* The present state as bytes that `wc_restore` accepts in any process that runs the same model. */
void wc_save(const wc_instance *c, wc_saved *to);
wc_result wc_restore(wc_instance *c, const char *function, const wc_saved *from);
wc_result wc_verify(const wc_instance *c, const char *function, const void *bytes, size_t size);

#endif
