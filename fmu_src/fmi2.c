/* FMI 2.0, Co-Simulation and Model Exchange: translates calls to instance.h. */
#ifdef FMI2_OVERRIDE_FUNCTION_PREFIX /* which fmi2Functions.h knows since FMI 2.0.4 */
#undef FMI2_FUNCTION_PREFIX
#endif
#include "fmi2Functions.h"

#include <stdlib.h>
#include <string.h>

#include "instance.h"

#define UNUSED(x) (void)(x)

typedef struct {
    wc_instance chair; /* first: an fmi2Component is also a wc_instance */
    fmi2CallbackLogger logger;
    fmi2ComponentEnvironment environment;
    char name[];
} component2;

/* Calls `call`, with the instance as c, where the phase allows it. */
#define WHERE2(function, legal, call)                              \
    do {                                                           \
        wc_instance *c = wc_enter(instance, function, legal);      \
        return c ? (fmi2Status)(call) : fmi2Error;                 \
    } while (0)

static void fmi2_log(void *host, int status, const char *category, const char *text) {
    component2 *c = host;
    if (!c->logger) return;
    char format[1024]; /* the logger takes a format: a percent sign counts twice */
    size_t n = 0;
    for (; *text && n + 2 < sizeof format; text++) {
        if (*text == '%') format[n++] = '%';
        format[n++] = *text;
    }
    format[n] = 0;
    c->logger(c->environment, c->name, (fmi2Status)status, category, format);
}

const char *fmi2GetTypesPlatform(void) { return fmi2TypesPlatform; }

const char *fmi2GetVersion(void) { return fmi2Version; }

/* ---- life ---- */

fmi2Component fmi2Instantiate(fmi2String name, fmi2Type type, fmi2String guid, fmi2String resources,
                              const fmi2CallbackFunctions *callbacks, fmi2Boolean visible, fmi2Boolean logging) {
    UNUSED(resources);
    UNUSED(visible);
    fmi2CallbackLogger logger = callbacks ? callbacks->logger : 0;
    fmi2ComponentEnvironment environment = callbacks ? callbacks->componentEnvironment : 0;
    wc_interface interface = type == fmi2ModelExchange ? WC_MODEL_EXCHANGE : WC_COSIMULATION;
    const char *fault = wc_refuse_instance(name, interface, guid);
    /* Not by the importer's allocateMemory: canNotUseMemoryManagementFunctions, as some importers have none that works. */
    component2 *c = fault ? 0 : calloc(1, sizeof *c + strlen(name) + 1);
    if (!c) {
        if (logger) {
            logger(environment, name ? name : "unnamed", fmi2Error, "logStatusError", "fmi2Instantiate: %s",
                   fault ? fault : "no memory left");
        }
        return 0;
    }
    c->logger = logger;
    c->environment = environment;
    strcpy(c->name, name);
    c->chair.standard = "fmi2";
    c->chair.log = fmi2_log;
    c->chair.host = c;
    wc_begin(&c->chair, interface, logging);
    return c;
}

void fmi2FreeInstance(fmi2Component instance) { wc_end(instance); }

fmi2Status fmi2SetDebugLogging(fmi2Component instance, fmi2Boolean on, size_t n, const fmi2String names[]) {
    WHERE2("fmi2SetDebugLogging", WC_ANY_PHASE, wc_set_logging(c, "fmi2SetDebugLogging", on, n, names));
}

fmi2Status fmi2SetupExperiment(fmi2Component instance, fmi2Boolean has_tolerance, fmi2Real tolerance, fmi2Real start,
                               fmi2Boolean has_stop, fmi2Real stop) {
    WHERE2("fmi2SetupExperiment", WC_INSTANTIATED,
          wc_set_up(c, "fmi2SetupExperiment", has_tolerance, tolerance, start, has_stop, stop));
}

fmi2Status fmi2EnterInitializationMode(fmi2Component instance) {
    wc_instance *c = wc_enter(instance, "fmi2EnterInitializationMode", WC_INSTANTIATED);
    if (!c) return fmi2Error;
    c->now.phase = WC_INITIALIZING;
    return fmi2OK;
}

fmi2Status fmi2ExitInitializationMode(fmi2Component instance) {
    WHERE2("fmi2ExitInitializationMode", WC_INITIALIZING, wc_leave_initialization(c, "fmi2ExitInitializationMode"));
}

fmi2Status fmi2Terminate(fmi2Component instance) {
    wc_instance *c = wc_enter(instance, "fmi2Terminate", WC_RUNNING);
    if (!c) return fmi2Error;
    c->now.phase = WC_TERMINATED;
    return fmi2OK;
}

fmi2Status fmi2Reset(fmi2Component instance) {
    wc_instance *c = wc_enter(instance, "fmi2Reset", WC_ANY_PHASE);
    if (!c) return fmi2Error;
    wc_reset(c);
    return fmi2OK;
}

/* ---- values ---- */

fmi2Status fmi2GetReal(fmi2Component instance, const fmi2ValueReference vr[], size_t n, fmi2Real value[]) {
    WHERE2("fmi2GetReal", WC_ANY_PHASE, wc_get_all(c, "fmi2GetReal", vr, n, WC_REAL, value, WC_DOUBLES));
}

fmi2Status fmi2GetInteger(fmi2Component instance, const fmi2ValueReference vr[], size_t n, fmi2Integer value[]) {
    WHERE2("fmi2GetInteger", WC_ANY_PHASE, wc_get_all(c, "fmi2GetInteger", vr, n, WC_ENUMERATION, value, WC_INTS));
}

fmi2Status fmi2GetBoolean(fmi2Component instance, const fmi2ValueReference vr[], size_t n, fmi2Boolean value[]) {
    WHERE2("fmi2GetBoolean", WC_ANY_PHASE, wc_get_all(c, "fmi2GetBoolean", vr, n, WC_BOOLEAN, value, WC_INTS));
}

fmi2Status fmi2SetReal(fmi2Component instance, const fmi2ValueReference vr[], size_t n, const fmi2Real value[]) {
    WHERE2("fmi2SetReal", WC_BEFORE_END, wc_set_all(c, "fmi2SetReal", vr, n, WC_REAL, value, WC_DOUBLES));
}

fmi2Status fmi2SetInteger(fmi2Component instance, const fmi2ValueReference vr[], size_t n, const fmi2Integer value[]) {
    WHERE2("fmi2SetInteger", WC_BEFORE_END, wc_set_all(c, "fmi2SetInteger", vr, n, WC_ENUMERATION, value, WC_INTS));
}

fmi2Status fmi2SetBoolean(fmi2Component instance, const fmi2ValueReference vr[], size_t n, const fmi2Boolean value[]) {
    WHERE2("fmi2SetBoolean", WC_BEFORE_END, wc_set_all(c, "fmi2SetBoolean", vr, n, WC_BOOLEAN, value, WC_INTS));
}

static const char NO_STRINGS[] = "this FMU has no variables of type String; modelDescription.xml lists all";

fmi2Status fmi2GetString(fmi2Component instance, const fmi2ValueReference vr[], size_t n, fmi2String value[]) {
    UNUSED(vr);
    UNUSED(value);
    WHERE2("fmi2GetString", WC_ANY_PHASE, n ? wc_unsupported(c, "fmi2GetString", NO_STRINGS) : WC_DONE);
}

fmi2Status fmi2SetString(fmi2Component instance, const fmi2ValueReference vr[], size_t n, const fmi2String value[]) {
    UNUSED(vr);
    UNUSED(value);
    WHERE2("fmi2SetString", WC_ANY_PHASE, n ? wc_unsupported(c, "fmi2SetString", NO_STRINGS) : WC_DONE);
}

/* ---- saved states ---- */

fmi2Status fmi2GetFMUstate(fmi2Component instance, fmi2FMUstate *state) {
    WHERE2("fmi2GetFMUstate", WC_ANY_PHASE, wc_get_state(c, "fmi2GetFMUstate", state));
}

fmi2Status fmi2SetFMUstate(fmi2Component instance, fmi2FMUstate state) {
    WHERE2("fmi2SetFMUstate", WC_ANY_PHASE, wc_set_state(c, "fmi2SetFMUstate", state));
}

fmi2Status fmi2FreeFMUstate(fmi2Component instance, fmi2FMUstate *state) {
    WHERE2("fmi2FreeFMUstate", WC_ANY_PHASE, wc_free_state(state));
}

fmi2Status fmi2SerializedFMUstateSize(fmi2Component instance, fmi2FMUstate state, size_t *size) {
    WHERE2("fmi2SerializedFMUstateSize", WC_ANY_PHASE, wc_state_size(c, "fmi2SerializedFMUstateSize", state, size));
}

fmi2Status fmi2SerializeFMUstate(fmi2Component instance, fmi2FMUstate state, fmi2Byte bytes[], size_t size) {
    WHERE2("fmi2SerializeFMUstate", WC_ANY_PHASE, wc_serialize(c, "fmi2SerializeFMUstate", state, bytes, size));
}

fmi2Status fmi2DeSerializeFMUstate(fmi2Component instance, const fmi2Byte bytes[], size_t size, fmi2FMUstate *state) {
    WHERE2("fmi2DeSerializeFMUstate", WC_ANY_PHASE, wc_deserialize(c, "fmi2DeSerializeFMUstate", bytes, size, state));
}

/* ---- derivatives ---- */

fmi2Status fmi2GetDirectionalDerivative(fmi2Component instance, const fmi2ValueReference unknown[], size_t n_unknown,
                                        const fmi2ValueReference known[], size_t n_known, const fmi2Real d_known[],
                                        fmi2Real d_unknown[]) {
    WHERE2("fmi2GetDirectionalDerivative", WC_INITIALIZING | WC_RUNNING | WC_TERMINATED,
          wc_directional(c, "fmi2GetDirectionalDerivative", unknown, n_unknown, known, n_known, d_known, d_unknown));
}

fmi2Status fmi2SetRealInputDerivatives(fmi2Component instance, const fmi2ValueReference vr[], size_t n,
                                       const fmi2Integer order[], const fmi2Real value[]) {
    WHERE2("fmi2SetRealInputDerivatives", WC_INSTANTIATED | WC_INITIALIZING | WC_STEPPING | WC_FOR_COSIMULATION,
          wc_input_slopes(c, "fmi2SetRealInputDerivatives", vr, n, order, value));
}

fmi2Status fmi2GetRealOutputDerivatives(fmi2Component instance, const fmi2ValueReference vr[], size_t n,
                                        const fmi2Integer order[], fmi2Real value[]) {
    WHERE2("fmi2GetRealOutputDerivatives", WC_STEPPING | WC_TERMINATED | WC_FOR_COSIMULATION,
          wc_output_slopes(c, "fmi2GetRealOutputDerivatives", vr, n, order, value));
}

/* ---- Co-Simulation ---- */

fmi2Status fmi2DoStep(fmi2Component instance, fmi2Real point, fmi2Real h, fmi2Boolean no_set_state) {
    UNUSED(no_set_state);
    WHERE2("fmi2DoStep", WC_STEPPING, wc_do_step(c, "fmi2DoStep", point, h));
}

fmi2Status fmi2CancelStep(fmi2Component instance) {
    return (fmi2Status)wc_unsupported(instance, "fmi2CancelStep",
                                      "fmi2DoStep returns only when done; there is nothing to cancel");
}

/* A status that this FMU never has. */
static fmi2Status no_status(wc_instance *c, const char *function, const char *why) {
    wc_say(c, WC_LOG_DISCARD, "%s: %s", function, why);
    return fmi2Discard;
}

fmi2Status fmi2GetStatus(fmi2Component instance, const fmi2StatusKind kind, fmi2Status *value) {
    UNUSED(kind);
    UNUSED(value);
    WHERE2("fmi2GetStatus", WC_ANY_PHASE,
          no_status(c, "fmi2GetStatus", "fmi2DoStep is never pending; take the status it returns"));
}

fmi2Status fmi2GetRealStatus(fmi2Component instance, const fmi2StatusKind kind, fmi2Real *value) {
    wc_instance *c = wc_enter(instance, "fmi2GetRealStatus", WC_ANY_PHASE);
    if (!c) return fmi2Error;
    if (!value) return (fmi2Status)wc_missing(c, "fmi2GetRealStatus", "value");
    if (kind != fmi2LastSuccessfulTime) {
        return no_status(c, "fmi2GetRealStatus", "only fmi2LastSuccessfulTime is a Real; ask for that");
    }
    *value = c->now.time;
    return fmi2OK;
}

fmi2Status fmi2GetIntegerStatus(fmi2Component instance, const fmi2StatusKind kind, fmi2Integer *value) {
    UNUSED(kind);
    UNUSED(value);
    WHERE2("fmi2GetIntegerStatus", WC_ANY_PHASE,
          no_status(c, "fmi2GetIntegerStatus", "FMI 2.0 has no such status; ask for another"));
}

fmi2Status fmi2GetBooleanStatus(fmi2Component instance, const fmi2StatusKind kind, fmi2Boolean *value) {
    wc_instance *c = wc_enter(instance, "fmi2GetBooleanStatus", WC_ANY_PHASE);
    if (!c) return fmi2Error;
    if (!value) return (fmi2Status)wc_missing(c, "fmi2GetBooleanStatus", "value");
    if (kind != fmi2Terminated) {
        return no_status(c, "fmi2GetBooleanStatus", "only fmi2Terminated is a Boolean; ask for that");
    }
    *value = fmi2False; /* the model itself never asks to end */
    return fmi2OK;
}

fmi2Status fmi2GetStringStatus(fmi2Component instance, const fmi2StatusKind kind, fmi2String *value) {
    UNUSED(kind);
    UNUSED(value);
    WHERE2("fmi2GetStringStatus", WC_ANY_PHASE,
          no_status(c, "fmi2GetStringStatus", "fmi2DoStep is never pending; take the status it returns"));
}

/* ---- Model Exchange ---- */

fmi2Status fmi2EnterEventMode(fmi2Component instance) {
    wc_instance *c = wc_enter(instance, "fmi2EnterEventMode", WC_CONTINUOUS);
    if (!c) return fmi2Error;
    c->now.phase = WC_EVENT;
    return fmi2OK;
}

fmi2Status fmi2NewDiscreteStates(fmi2Component instance, fmi2EventInfo *info) {
    wc_instance *c = wc_enter(instance, "fmi2NewDiscreteStates", WC_EVENT);
    if (!c) return fmi2Error;
    if (!info) return (fmi2Status)wc_missing(c, "fmi2NewDiscreteStates", "fmi2eventInfo");
    int jumped = 0;
    wc_result result = wc_update_discrete(c, "fmi2NewDiscreteStates", &jumped);
    if (result != WC_DONE) return (fmi2Status)result;
    *info = (fmi2EventInfo){.valuesOfContinuousStatesChanged = jumped};
    return fmi2OK;
}

fmi2Status fmi2EnterContinuousTimeMode(fmi2Component instance) {
    WHERE2("fmi2EnterContinuousTimeMode", WC_EVENT, wc_enter_continuous(c, "fmi2EnterContinuousTimeMode"));
}

fmi2Status fmi2CompletedIntegratorStep(fmi2Component instance, fmi2Boolean no_set_state, fmi2Boolean *enter_event_mode,
                                       fmi2Boolean *terminate) {
    UNUSED(no_set_state);
    wc_instance *c = wc_enter(instance, "fmi2CompletedIntegratorStep", WC_CONTINUOUS);
    if (!c) return fmi2Error;
    if (!enter_event_mode || !terminate) {
        return (fmi2Status)wc_missing(c, "fmi2CompletedIntegratorStep", "enterEventMode or terminateSimulation");
    }
    *enter_event_mode = *terminate = fmi2False;
    return (fmi2Status)wc_complete_step(c, "fmi2CompletedIntegratorStep");
}

fmi2Status fmi2SetTime(fmi2Component instance, fmi2Real time) {
    WHERE2("fmi2SetTime", WC_EVENT | WC_CONTINUOUS, wc_set_time(c, "fmi2SetTime", time));
}

fmi2Status fmi2SetContinuousStates(fmi2Component instance, const fmi2Real x[], size_t n) {
    WHERE2("fmi2SetContinuousStates", WC_CONTINUOUS, wc_set_states(c, "fmi2SetContinuousStates", x, n));
}

fmi2Status fmi2GetContinuousStates(fmi2Component instance, fmi2Real x[], size_t n) {
    WHERE2("fmi2GetContinuousStates", WC_EVALUATION,
          wc_get_states(c, "fmi2GetContinuousStates", x, n));
}

fmi2Status fmi2GetDerivatives(fmi2Component instance, fmi2Real derivatives[], size_t n) {
    WHERE2("fmi2GetDerivatives", WC_EVALUATION,
          wc_get_rates(c, "fmi2GetDerivatives", derivatives, n));
}

fmi2Status fmi2GetEventIndicators(fmi2Component instance, fmi2Real indicators[], size_t n) {
    WHERE2("fmi2GetEventIndicators", WC_EVALUATION,
          wc_get_crossings(c, "fmi2GetEventIndicators", indicators, n));
}

fmi2Status fmi2GetNominalsOfContinuousStates(fmi2Component instance, fmi2Real nominals[], size_t n) {
    WHERE2("fmi2GetNominalsOfContinuousStates", WC_EVALUATION,
          wc_get_nominals(c, "fmi2GetNominalsOfContinuousStates", nominals, n));
}
