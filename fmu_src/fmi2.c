/* FMI 2.0 Co-Simulation: translates calls to instance.h, and refuses what comes in the wrong order. */
#include "fmi2Functions.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "instance.h"

#define UNUSED(x) (void)(x)
#define ANY_PHASE (WC_INSTANTIATED | WC_INITIALIZING | WC_STEPPING | WC_TERMINATED)
#define BEFORE_END (WC_INSTANTIATED | WC_INITIALIZING | WC_STEPPING)

static const struct {
    const char *name;
    wc_category category;
    fmi2Status status;
} CATEGORIES[] = {
    {"logStatusWarning", WC_LOG_WARNING, fmi2Warning},
    {"logStatusDiscard", WC_LOG_DISCARD, fmi2Discard},
    {"logStatusError", WC_LOG_ERROR, fmi2Error},
    {"logModel", WC_LOG_MODEL, fmi2OK},
};
#define CATEGORY_COUNT ((int)(sizeof CATEGORIES / sizeof *CATEGORIES))
#define ALL_CATEGORIES (WC_LOG_WARNING | WC_LOG_DISCARD | WC_LOG_ERROR | WC_LOG_MODEL)

typedef struct {
    wc_instance chair; /* first, so that the log finds its way back */
    fmi2CallbackLogger logger;
    fmi2CallbackAllocateMemory allocate;
    fmi2CallbackFreeMemory release;
    fmi2ComponentEnvironment environment;
    unsigned categories; /* switched on */
    char name[];
} component;

/* ---- log, memory, order of calls ---- */

static void log_text(void *host, wc_category category, const char *text) {
    component *c = host;
    if (!c->logger || !(c->categories & category)) return;
    char format[1024]; /* the logger takes a format: a percent sign counts twice */
    size_t n = 0;
    for (; *text && n + 2 < sizeof format; text++) {
        if (*text == '%') format[n++] = '%';
        format[n++] = *text;
    }
    format[n] = 0;
    for (int i = 0; i < CATEGORY_COUNT; i++) {
        if (CATEGORIES[i].category == category) {
            c->logger(c->environment, c->name, CATEGORIES[i].status, CATEGORIES[i].name, format);
        }
    }
}

static fmi2Status status_of(wc_result result) {
    return result == WC_DONE ? fmi2OK : result == WC_DISCARDED ? fmi2Discard : fmi2Error;
}

/* The component, where the call is legal in its phase; else 0, and a sentence that names the legal ones. */
static component *enter(fmi2Component instance, const char *function, int legal) {
    static const struct {
        wc_phase phase;
        const char *name, *when;
    } phases[] = {
        {WC_INSTANTIATED, "instantiated", "between fmi2Instantiate and fmi2EnterInitializationMode"},
        {WC_INITIALIZING, "initialization mode", "in initialization mode"},
        {WC_STEPPING, "stepping", "after fmi2ExitInitializationMode"},
        {WC_TERMINATED, "terminated", "after fmi2Terminate"},
    };
    component *c = instance;
    if (!c) return 0;
    if (c->chair.now.phase & legal) return c;
    char when[200] = "";
    const char *now = "";
    for (int i = 0; i < 4; i++) {
        if (phases[i].phase == (wc_phase)c->chair.now.phase) now = phases[i].name;
        if (!(phases[i].phase & legal)) continue;
        if (*when) strcat(when, " or ");
        strcat(when, phases[i].when);
    }
    wc_say(&c->chair, WC_LOG_ERROR, "%s is not allowed while the FMU is \"%s\"; call it %s", function, now, when);
    return 0;
}

static fmi2Status missing(component *c, const char *function, const char *what) {
    wc_say(&c->chair, WC_LOG_ERROR, "%s: %s is a null pointer; give an array", function, what);
    return fmi2Error;
}

const char *fmi2GetTypesPlatform(void) { return fmi2TypesPlatform; }

const char *fmi2GetVersion(void) { return fmi2Version; }

/* ---- life ---- */

fmi2Component fmi2Instantiate(fmi2String name, fmi2Type type, fmi2String guid, fmi2String resources,
                              const fmi2CallbackFunctions *callbacks, fmi2Boolean visible, fmi2Boolean logging) {
    UNUSED(resources);
    UNUSED(visible);
    const char *fault = 0;
    fmi2CallbackLogger logger = callbacks ? callbacks->logger : 0;
    fmi2ComponentEnvironment environment = callbacks ? callbacks->componentEnvironment : 0;
    if (!name || !*name) {
        fault = "fmi2Instantiate: the instance has no name; give one";
        name = "unnamed";
    } else if (type != fmi2CoSimulation) {
        fault = "fmi2Instantiate: this FMU is for co-simulation; ask for fmi2CoSimulation";
    } else if (!guid || strcmp(guid, wc_the_model.token)) {
        fault = "fmi2Instantiate: the guid is not this library's; take modelDescription.xml and library from one archive";
    }
    if (fault) {
        if (logger) logger(environment, name, fmi2Error, "logStatusError", fault);
        return 0;
    }
    int own = callbacks && callbacks->allocateMemory && callbacks->freeMemory;
    fmi2CallbackAllocateMemory allocate = own ? callbacks->allocateMemory : calloc;
    component *c = allocate(1, sizeof *c + strlen(name) + 1);
    if (!c) {
        if (logger) logger(environment, name, fmi2Error, "logStatusError", "fmi2Instantiate: no memory left");
        return 0;
    }
    memset(c, 0, sizeof *c);
    c->logger = logger;
    c->allocate = allocate;
    c->release = own ? callbacks->freeMemory : free;
    c->environment = environment;
    /* A refusal without its reason helps nobody, so reasons are told even where logging is off. */
    c->categories = logging ? ALL_CATEGORIES : ALL_CATEGORIES & ~(unsigned)WC_LOG_MODEL;
    strcpy(c->name, name);
    c->chair.log = log_text;
    c->chair.host = c;
    wc_reset(&c->chair);
    return c;
}

void fmi2FreeInstance(fmi2Component instance) {
    component *c = instance;
    if (c) c->release(c);
}

fmi2Status fmi2SetDebugLogging(fmi2Component instance, fmi2Boolean on, size_t n, const fmi2String names[]) {
    component *c = enter(instance, "fmi2SetDebugLogging", ANY_PHASE);
    if (!c) return fmi2Error;
    if (n && !names) return missing(c, "fmi2SetDebugLogging", "categories");
    unsigned chosen = n ? 0 : ALL_CATEGORIES;
    for (size_t i = 0; i < n; i++) {
        int known = 0;
        for (int j = 0; j < CATEGORY_COUNT; j++) {
            if (names[i] && !strcmp(names[i], CATEGORIES[j].name)) {
                chosen |= CATEGORIES[j].category;
                known = 1;
            }
        }
        if (!known) {
            wc_say(&c->chair, WC_LOG_ERROR, "fmi2SetDebugLogging: no log category \"%.60s\"; known: %s, %s, %s, %s",
                   names[i] ? names[i] : "(null)", CATEGORIES[0].name, CATEGORIES[1].name, CATEGORIES[2].name,
                   CATEGORIES[3].name);
            return fmi2Error;
        }
    }
    c->categories = on ? c->categories | chosen : c->categories & ~chosen;
    return fmi2OK;
}

fmi2Status fmi2SetupExperiment(fmi2Component instance, fmi2Boolean has_tolerance, fmi2Real tolerance, fmi2Real start,
                               fmi2Boolean has_stop, fmi2Real stop) {
    component *c = enter(instance, "fmi2SetupExperiment", WC_INSTANTIATED);
    if (!c) return fmi2Error;
    if (!isfinite(start) || (has_stop && !(stop >= start))) {
        wc_say(&c->chair, WC_LOG_ERROR, "fmi2SetupExperiment: start %g s and stop %g s are no span of time; give finite "
               "times, the stop not before the start", start, stop);
        return fmi2Error;
    }
    if (has_tolerance && !(tolerance > 0)) {
        wc_say(&c->chair, WC_LOG_ERROR, "fmi2SetupExperiment: a tolerance of %g is not positive; give one, e.g. 1e-7",
               tolerance);
        return fmi2Error;
    }
    wc_saved *s = &c->chair.now;
    s->tolerance = !has_tolerance ? wc_the_model.tolerance : tolerance < 1e-12 ? 1e-12 : tolerance > 1e-3 ? 1e-3
                                                                                                        : tolerance;
    s->start_time = s->time = start;
    s->has_stop = has_stop ? 1 : 0;
    s->stop_time = has_stop ? stop : 0;
    wc_say(&c->chair, WC_LOG_MODEL, "starts at t = %.9g s, tolerance %g, internal steps of at most %g s", start,
           s->tolerance, wc_the_model.grid);
    return fmi2OK;
}

fmi2Status fmi2EnterInitializationMode(fmi2Component instance) {
    component *c = enter(instance, "fmi2EnterInitializationMode", WC_INSTANTIATED);
    if (!c) return fmi2Error;
    c->chair.now.phase = WC_INITIALIZING;
    return fmi2OK;
}

fmi2Status fmi2ExitInitializationMode(fmi2Component instance) {
    component *c = enter(instance, "fmi2ExitInitializationMode", WC_INITIALIZING);
    if (!c) return fmi2Error;
    wc_result result = wc_settle(&c->chair, "fmi2ExitInitializationMode");
    if (result == WC_DONE) c->chair.now.phase = WC_STEPPING;
    return status_of(result);
}

fmi2Status fmi2Terminate(fmi2Component instance) {
    component *c = enter(instance, "fmi2Terminate", WC_STEPPING);
    if (!c) return fmi2Error;
    c->chair.now.phase = WC_TERMINATED;
    return fmi2OK;
}

fmi2Status fmi2Reset(fmi2Component instance) {
    component *c = enter(instance, "fmi2Reset", ANY_PHASE);
    if (!c) return fmi2Error;
    wc_reset(&c->chair);
    return fmi2OK;
}

/* ---- values ---- */

/* The i-th of an array whose type depends on the call. */
typedef struct {
    const fmi2Real *real;
    const fmi2Integer *integer;
} values;

static double value_at(const values *from, size_t i) { return from->real ? from->real[i] : (double)from->integer[i]; }

static fmi2Status set_all(fmi2Component instance, const char *function, const fmi2ValueReference vr[], size_t n,
                          wc_type type, values from) {
    component *c = enter(instance, function, BEFORE_END);
    if (!c) return fmi2Error;
    if (n && (!vr || (!from.real && !from.integer))) return missing(c, function, vr ? "value" : "vr");
    for (size_t i = 0; i < n; i++) { /* all or none */
        const wc_variable *v = wc_find(&c->chair, function, vr[i], type);
        if (!v) return fmi2Error;
        wc_result result = wc_check(&c->chair, function, v, value_at(&from, i));
        if (result != WC_DONE) return status_of(result);
    }
    for (size_t i = 0; i < n; i++) wc_set(&c->chair, &wc_the_model.variable[vr[i]], value_at(&from, i));
    return fmi2OK;
}

static fmi2Status get_all(fmi2Component instance, const char *function, const fmi2ValueReference vr[], size_t n,
                          wc_type type, fmi2Real *real, fmi2Integer *integer) {
    component *c = enter(instance, function, ANY_PHASE);
    if (!c) return fmi2Error;
    if (n && (!vr || (!real && !integer))) return missing(c, function, vr ? "value" : "vr");
    for (size_t i = 0; i < n; i++) {
        double value;
        const wc_variable *v = wc_find(&c->chair, function, vr[i], type);
        if (!v) return fmi2Error;
        wc_result result = wc_get(&c->chair, v, &value);
        if (result != WC_DONE) return status_of(result);
        if (real) {
            real[i] = value;
        } else {
            integer[i] = type == WC_BOOLEAN ? value != 0 : (fmi2Integer)value;
        }
    }
    return fmi2OK;
}

fmi2Status fmi2GetReal(fmi2Component c, const fmi2ValueReference vr[], size_t n, fmi2Real value[]) {
    return get_all(c, "fmi2GetReal", vr, n, WC_REAL, value, 0);
}

fmi2Status fmi2GetInteger(fmi2Component c, const fmi2ValueReference vr[], size_t n, fmi2Integer value[]) {
    return get_all(c, "fmi2GetInteger", vr, n, WC_ENUMERATION, 0, value);
}

fmi2Status fmi2GetBoolean(fmi2Component c, const fmi2ValueReference vr[], size_t n, fmi2Boolean value[]) {
    return get_all(c, "fmi2GetBoolean", vr, n, WC_BOOLEAN, 0, value);
}

fmi2Status fmi2SetReal(fmi2Component c, const fmi2ValueReference vr[], size_t n, const fmi2Real value[]) {
    return set_all(c, "fmi2SetReal", vr, n, WC_REAL, (values){.real = value});
}

fmi2Status fmi2SetInteger(fmi2Component c, const fmi2ValueReference vr[], size_t n, const fmi2Integer value[]) {
    return set_all(c, "fmi2SetInteger", vr, n, WC_ENUMERATION, (values){.integer = value});
}

fmi2Status fmi2SetBoolean(fmi2Component c, const fmi2ValueReference vr[], size_t n, const fmi2Boolean value[]) {
    return set_all(c, "fmi2SetBoolean", vr, n, WC_BOOLEAN, (values){.integer = value});
}

static fmi2Status no_strings(fmi2Component instance, const char *function, size_t n) {
    component *c = enter(instance, function, ANY_PHASE);
    if (!c) return fmi2Error;
    if (!n) return fmi2OK;
    wc_say(&c->chair, WC_LOG_ERROR, "%s: this FMU has no variables of type String; modelDescription.xml lists all",
           function);
    return fmi2Error;
}

fmi2Status fmi2GetString(fmi2Component c, const fmi2ValueReference vr[], size_t n, fmi2String value[]) {
    UNUSED(vr);
    UNUSED(value);
    return no_strings(c, "fmi2GetString", n);
}

fmi2Status fmi2SetString(fmi2Component c, const fmi2ValueReference vr[], size_t n, const fmi2String value[]) {
    UNUSED(vr);
    UNUSED(value);
    return no_strings(c, "fmi2SetString", n);
}

/* ---- saved states ---- */

static wc_saved *new_state(component *c, const char *function) {
    wc_saved *s = c->allocate(1, sizeof *s);
    if (!s) wc_say(&c->chair, WC_LOG_ERROR, "%s: no memory left", function);
    return s;
}

fmi2Status fmi2GetFMUstate(fmi2Component instance, fmi2FMUstate *state) {
    component *c = enter(instance, "fmi2GetFMUstate", ANY_PHASE);
    if (!c) return fmi2Error;
    if (!state) return missing(c, "fmi2GetFMUstate", "FMUstate");
    if (!*state) *state = new_state(c, "fmi2GetFMUstate");
    if (!*state) return fmi2Error;
    wc_save(&c->chair, *state);
    return fmi2OK;
}

fmi2Status fmi2SetFMUstate(fmi2Component instance, fmi2FMUstate state) {
    component *c = enter(instance, "fmi2SetFMUstate", ANY_PHASE);
    if (!c) return fmi2Error;
    if (!state) return missing(c, "fmi2SetFMUstate", "FMUstate");
    return status_of(wc_restore(&c->chair, "fmi2SetFMUstate", state));
}

fmi2Status fmi2FreeFMUstate(fmi2Component instance, fmi2FMUstate *state) {
    component *c = enter(instance, "fmi2FreeFMUstate", ANY_PHASE);
    if (!c) return fmi2Error;
    if (state && *state) {
        c->release(*state);
        *state = 0;
    }
    return fmi2OK;
}

fmi2Status fmi2SerializedFMUstateSize(fmi2Component instance, fmi2FMUstate state, size_t *size) {
    component *c = enter(instance, "fmi2SerializedFMUstateSize", ANY_PHASE);
    if (!c) return fmi2Error;
    if (!state || !size) return missing(c, "fmi2SerializedFMUstateSize", state ? "size" : "FMUstate");
    *size = sizeof(wc_saved);
    return fmi2OK;
}

fmi2Status fmi2SerializeFMUstate(fmi2Component instance, fmi2FMUstate state, fmi2Byte bytes[], size_t size) {
    component *c = enter(instance, "fmi2SerializeFMUstate", ANY_PHASE);
    if (!c) return fmi2Error;
    if (!state || !bytes) return missing(c, "fmi2SerializeFMUstate", state ? "serializedState" : "FMUstate");
    if (size < sizeof(wc_saved)) {
        wc_say(&c->chair, WC_LOG_ERROR, "fmi2SerializeFMUstate: %lu bytes are too few; give %lu", (unsigned long)size,
               (unsigned long)sizeof(wc_saved));
        return fmi2Error;
    }
    memcpy(bytes, state, sizeof(wc_saved));
    return fmi2OK;
}

fmi2Status fmi2DeSerializeFMUstate(fmi2Component instance, const fmi2Byte bytes[], size_t size, fmi2FMUstate *state) {
    component *c = enter(instance, "fmi2DeSerializeFMUstate", ANY_PHASE);
    if (!c) return fmi2Error;
    if (!state) return missing(c, "fmi2DeSerializeFMUstate", "FMUstate");
    wc_result result = wc_verify(&c->chair, "fmi2DeSerializeFMUstate", bytes, size);
    if (result != WC_DONE) return status_of(result);
    if (!*state) *state = new_state(c, "fmi2DeSerializeFMUstate");
    if (!*state) return fmi2Error;
    memcpy(*state, bytes, sizeof(wc_saved));
    return fmi2OK;
}

/* ---- derivatives ---- */

fmi2Status fmi2GetDirectionalDerivative(fmi2Component instance, const fmi2ValueReference unknown[], size_t n_unknown,
                                        const fmi2ValueReference known[], size_t n_known, const fmi2Real d_known[],
                                        fmi2Real d_unknown[]) {
    static const char *const function = "fmi2GetDirectionalDerivative";
    component *c = enter(instance, function, WC_INITIALIZING | WC_STEPPING | WC_TERMINATED);
    if (!c) return fmi2Error;
    if (n_unknown && (!unknown || !d_unknown)) return missing(c, function, unknown ? "dvUnknown" : "vUnknown_ref");
    if (n_known && (!known || !d_known)) return missing(c, function, known ? "dvKnown" : "vKnown_ref");
    double dw[WC_MAX_INPUTS] = {0}, dp[WC_MAX_PARAMETERS] = {0}, dy[WC_MAX_OUTPUTS];
    for (size_t i = 0; i < n_known; i++) {
        const wc_variable *v = wc_find(&c->chair, function, known[i], WC_REAL);
        if (!v) return fmi2Error;
        if (v->kind == WC_OUTPUT || v->kind == WC_TIME || (v->fixed && c->chair.now.phase != WC_INITIALIZING)) {
            wc_say(&c->chair, WC_LOG_ERROR, "%s: %s cannot change now, so nothing varies with it; give inputs and "
                   "tunable parameters", function, v->name);
            return fmi2Error;
        }
        (v->kind == WC_INPUT ? dw : dp)[v->index] += d_known[i];
    }
    for (size_t i = 0; i < n_unknown; i++) {
        const wc_variable *v = wc_find(&c->chair, function, unknown[i], WC_REAL);
        if (!v) return fmi2Error;
        if (v->kind != WC_OUTPUT) {
            wc_say(&c->chair, WC_LOG_ERROR, "%s: %s is no output; give outputs as unknowns", function, v->name);
            return fmi2Error;
        }
    }
    wc_result result = wc_directional(&c->chair, function, dw, dp, dy);
    if (result != WC_DONE) return status_of(result);
    for (size_t i = 0; i < n_unknown; i++) d_unknown[i] = dy[wc_the_model.variable[unknown[i]].index];
    return fmi2OK;
}

fmi2Status fmi2SetRealInputDerivatives(fmi2Component instance, const fmi2ValueReference vr[], size_t n,
                                       const fmi2Integer order[], const fmi2Real value[]) {
    static const char *const function = "fmi2SetRealInputDerivatives";
    component *c = enter(instance, function, BEFORE_END);
    if (!c) return fmi2Error;
    if (n && (!vr || !order || !value)) return missing(c, function, !vr ? "vr" : !order ? "order" : "value");
    for (size_t i = 0; i < n; i++) {
        const wc_variable *v = wc_find(&c->chair, function, vr[i], WC_REAL);
        if (!v) return fmi2Error;
        if (v->kind != WC_INPUT || order[i] != 1) {
            wc_say(&c->chair, WC_LOG_ERROR, "%s: %s, order %d: only inputs take a derivative, and only the first", function,
                   v->name, (int)order[i]);
            return fmi2Error;
        }
        if (!isfinite(value[i])) {
            wc_say(&c->chair, WC_LOG_DISCARD, "%s: the derivative of %s is not a finite number; the old one stays",
                   function, v->name);
            return fmi2Discard;
        }
    }
    for (size_t i = 0; i < n; i++) c->chair.now.slope[wc_the_model.variable[vr[i]].index] = value[i];
    return fmi2OK;
}

fmi2Status fmi2GetRealOutputDerivatives(fmi2Component instance, const fmi2ValueReference vr[], size_t n,
                                        const fmi2Integer order[], fmi2Real value[]) {
    UNUSED(vr);
    UNUSED(order);
    UNUSED(value);
    component *c = enter(instance, "fmi2GetRealOutputDerivatives", WC_STEPPING | WC_TERMINATED);
    if (!c) return fmi2Error;
    if (!n) return fmi2OK;
    wc_say(&c->chair, WC_LOG_ERROR, "fmi2GetRealOutputDerivatives: this FMU gives no derivatives of outputs "
           "(maxOutputDerivativeOrder is 0); read the outputs themselves");
    return fmi2Error;
}

/* ---- steps ---- */

fmi2Status fmi2DoStep(fmi2Component instance, fmi2Real point, fmi2Real h, fmi2Boolean no_set_state) {
    UNUSED(no_set_state);
    component *c = enter(instance, "fmi2DoStep", WC_STEPPING);
    return c ? status_of(wc_do_step(&c->chair, "fmi2DoStep", point, h)) : fmi2Error;
}

fmi2Status fmi2CancelStep(fmi2Component instance) {
    component *c = enter(instance, "fmi2CancelStep", ANY_PHASE);
    if (c) wc_say(&c->chair, WC_LOG_ERROR, "fmi2CancelStep: fmi2DoStep returns only when done; there is nothing to cancel");
    return fmi2Error;
}

fmi2Status fmi2GetStatus(fmi2Component instance, const fmi2StatusKind kind, fmi2Status *value) {
    UNUSED(kind);
    component *c = enter(instance, "fmi2GetStatus", ANY_PHASE);
    if (!c) return fmi2Error;
    if (!value) return missing(c, "fmi2GetStatus", "value");
    wc_say(&c->chair, WC_LOG_DISCARD, "fmi2GetStatus: fmi2DoStep is never pending; take the status it returns");
    return fmi2Discard;
}

fmi2Status fmi2GetRealStatus(fmi2Component instance, const fmi2StatusKind kind, fmi2Real *value) {
    component *c = enter(instance, "fmi2GetRealStatus", ANY_PHASE);
    if (!c) return fmi2Error;
    if (!value) return missing(c, "fmi2GetRealStatus", "value");
    if (kind == fmi2LastSuccessfulTime) {
        *value = c->chair.now.time;
        return fmi2OK;
    }
    wc_say(&c->chair, WC_LOG_DISCARD, "fmi2GetRealStatus: only fmi2LastSuccessfulTime is a Real; ask for that");
    return fmi2Discard;
}

fmi2Status fmi2GetIntegerStatus(fmi2Component instance, const fmi2StatusKind kind, fmi2Integer *value) {
    UNUSED(kind);
    UNUSED(value);
    component *c = enter(instance, "fmi2GetIntegerStatus", ANY_PHASE);
    if (!c) return fmi2Error;
    wc_say(&c->chair, WC_LOG_DISCARD, "fmi2GetIntegerStatus: FMI 2.0 has no such status; ask for another");
    return fmi2Discard;
}

fmi2Status fmi2GetBooleanStatus(fmi2Component instance, const fmi2StatusKind kind, fmi2Boolean *value) {
    component *c = enter(instance, "fmi2GetBooleanStatus", ANY_PHASE);
    if (!c) return fmi2Error;
    if (!value) return missing(c, "fmi2GetBooleanStatus", "value");
    if (kind == fmi2Terminated) {
        *value = fmi2False; /* the chair itself never asks to end */
        return fmi2OK;
    }
    wc_say(&c->chair, WC_LOG_DISCARD, "fmi2GetBooleanStatus: only fmi2Terminated is a Boolean; ask for that");
    return fmi2Discard;
}

fmi2Status fmi2GetStringStatus(fmi2Component instance, const fmi2StatusKind kind, fmi2String *value) {
    UNUSED(kind);
    component *c = enter(instance, "fmi2GetStringStatus", ANY_PHASE);
    if (!c) return fmi2Error;
    if (!value) return missing(c, "fmi2GetStringStatus", "value");
    *value = "fmi2DoStep is never pending";
    return fmi2OK;
}
