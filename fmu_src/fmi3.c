/* FMI 3.0, Co-Simulation and Model Exchange: translates calls to instance.h. */
#include "fmi3Functions.h"

#include <stdlib.h>
#include <string.h>

#include "instance.h"

#define UNUSED(x) (void)(x)

typedef struct {
    wc_instance chair; /* first: an fmi3Instance is also a wc_instance */
    fmi3LogMessageCallback logger;
    fmi3IntermediateUpdateCallback update;
    fmi3InstanceEnvironment environment;
    int may_return_early;
} component3;

/* Calls `call`, with the instance as c, where the phase allows it. */
#define WHERE3(function, legal, call)                              \
    do {                                                           \
        wc_instance *c = wc_enter(instance, function, legal);      \
        return c ? (fmi3Status)(call) : fmi3Error;                 \
    } while (0)

static void fmi3_log(void *host, int status, const char *category, const char *text) {
    component3 *c = host;
    if (c->logger) c->logger(c->environment, (fmi3Status)status, category, text);
}

/* An internal step is done: the importer may read, set inputs, and ask for an early return. */
static void tell(void *host, double time, double *end) {
    component3 *c = host;
    fmi3Boolean early = fmi3False;
    fmi3Float64 until = *end;
    c->update(c->environment, time, fmi3True, fmi3True, fmi3True, c->may_return_early, &early, &until);
    if (early && c->may_return_early) *end = until;
}

const char *fmi3GetVersion(void) { return fmi3Version; }

/* ---- life ---- */

static component3 *instantiate(const char *function, fmi3String name, wc_interface interface, fmi3String token,
                              fmi3Boolean logging, fmi3InstanceEnvironment environment, fmi3LogMessageCallback logger,
                              const char *fault) {
    if (!fault) fault = wc_refuse_instance(name, interface, token);
    component3 *c = fault ? 0 : calloc(1, sizeof *c);
    if (!c) {
        char text[256] = "";
        strncat(text, function, 100);
        strcat(text, ": ");
        strncat(text, fault ? fault : "no memory left", 140);
        if (logger) logger(environment, fmi3Error, "logStatusError", text);
        return 0;
    }
    c->logger = logger;
    c->environment = environment;
    c->chair.standard = "fmi3";
    c->chair.log = fmi3_log;
    c->chair.host = c;
    wc_begin(&c->chair, interface, logging);
    return c;
}

fmi3Instance fmi3InstantiateModelExchange(fmi3String name, fmi3String token, fmi3String resources, fmi3Boolean visible,
                                          fmi3Boolean logging, fmi3InstanceEnvironment environment,
                                          fmi3LogMessageCallback logger) {
    UNUSED(resources);
    UNUSED(visible);
    return instantiate("fmi3InstantiateModelExchange", name, WC_MODEL_EXCHANGE, token, logging, environment, logger, 0);
}

fmi3Instance fmi3InstantiateCoSimulation(fmi3String name, fmi3String token, fmi3String resources, fmi3Boolean visible,
                                         fmi3Boolean logging, fmi3Boolean event_mode, fmi3Boolean early_return,
                                         const fmi3ValueReference required[], size_t n_required,
                                         fmi3InstanceEnvironment environment, fmi3LogMessageCallback logger,
                                         fmi3IntermediateUpdateCallback update) {
    UNUSED(resources);
    UNUSED(visible);
    UNUSED(required); /* every variable can be had in an intermediate update */
    UNUSED(n_required);
    component3 *c = instantiate("fmi3InstantiateCoSimulation", name, WC_COSIMULATION, token, logging, environment, logger,
                               event_mode ? "Co-Simulation has no event mode here (hasEventMode is false); pass "
                                            "eventModeUsed = false" : 0);
    if (!c) return 0;
    c->update = update;
    c->may_return_early = early_return;
    c->chair.pause = update ? tell : 0;
    return c;
}

fmi3Instance fmi3InstantiateScheduledExecution(fmi3String name, fmi3String token, fmi3String resources,
                                               fmi3Boolean visible, fmi3Boolean logging,
                                               fmi3InstanceEnvironment environment, fmi3LogMessageCallback logger,
                                               fmi3ClockUpdateCallback clock_update,
                                               fmi3LockPreemptionCallback lock,
                                               fmi3UnlockPreemptionCallback unlock) {
    UNUSED(resources);
    UNUSED(visible);
    UNUSED(clock_update);
    UNUSED(lock);
    UNUSED(unlock);
    return instantiate("fmi3InstantiateScheduledExecution", name, WC_COSIMULATION, token, logging, environment, logger,
                       "this FMU is for Co-Simulation and Model Exchange; instantiate one of these");
}

void fmi3FreeInstance(fmi3Instance instance) { wc_end(instance); }

fmi3Status fmi3SetDebugLogging(fmi3Instance instance, fmi3Boolean on, size_t n, const fmi3String names[]) {
    WHERE3("fmi3SetDebugLogging", WC_ANY_PHASE, wc_set_logging(c, "fmi3SetDebugLogging", on, n, names));
}

fmi3Status fmi3EnterInitializationMode(fmi3Instance instance, fmi3Boolean has_tolerance, fmi3Float64 tolerance,
                                       fmi3Float64 start, fmi3Boolean has_stop, fmi3Float64 stop) {
    static const char *const function = "fmi3EnterInitializationMode";
    wc_instance *c = wc_enter(instance, function, WC_INSTANTIATED);
    if (!c) return fmi3Error;
    wc_result result = wc_set_up(c, function, has_tolerance, tolerance, start, has_stop, stop);
    if (result == WC_DONE) c->now.phase = WC_INITIALIZING;
    return (fmi3Status)result;
}

fmi3Status fmi3ExitInitializationMode(fmi3Instance instance) {
    WHERE3("fmi3ExitInitializationMode", WC_INITIALIZING, wc_leave_initialization(c, "fmi3ExitInitializationMode"));
}

fmi3Status fmi3Terminate(fmi3Instance instance) {
    wc_instance *c = wc_enter(instance, "fmi3Terminate", WC_RUNNING);
    if (!c) return fmi3Error;
    c->now.phase = WC_TERMINATED;
    return fmi3OK;
}

fmi3Status fmi3Reset(fmi3Instance instance) {
    wc_instance *c = wc_enter(instance, "fmi3Reset", WC_ANY_PHASE & ~WC_BETWEEN);
    if (!c) return fmi3Error;
    wc_reset(c);
    return fmi3OK;
}

/* ---- values ---- */

/* There is one value for each reference: no variable is an array. */
static fmi3Status wrong_count(wc_instance *c, const char *function, size_t n, size_t values) {
    wc_say(c, WC_LOG_ERROR, "%s: %lu value references have %lu values, not %lu, as no variable is an array", function,
           (unsigned long)n, (unsigned long)n, (unsigned long)values);
    return fmi3Error;
}

#define GETTER(function, legal, type, array)                                                                       \
    fmi3Status fmi3Get##function(fmi3Instance instance, const fmi3ValueReference vr[], size_t n,                  \
                                 fmi3##function values[], size_t n_values) {                                       \
        wc_instance *c = wc_enter(instance, "fmi3Get" #function, legal);                                           \
        if (!c) return fmi3Error;                                                                                  \
        if (n != n_values) return wrong_count(c, "fmi3Get" #function, n, n_values);                                \
        return (fmi3Status)wc_get_all(c, "fmi3Get" #function, vr, n, type, values, array);                         \
    }
#define SETTER(function, legal, type, array)                                                                       \
    fmi3Status fmi3Set##function(fmi3Instance instance, const fmi3ValueReference vr[], size_t n,                  \
                                 const fmi3##function values[], size_t n_values) {                                 \
        wc_instance *c = wc_enter(instance, "fmi3Set" #function, legal);                                           \
        if (!c) return fmi3Error;                                                                                  \
        if (n != n_values) return wrong_count(c, "fmi3Set" #function, n, n_values);                                \
        return (fmi3Status)wc_set_all(c, "fmi3Set" #function, vr, n, type, values, array);                         \
    }

GETTER(Float64, WC_ANY_PHASE, WC_REAL, WC_DOUBLES)
GETTER(Int64, WC_ANY_PHASE, WC_ENUMERATION, WC_INT64S)
GETTER(Boolean, WC_ANY_PHASE, WC_BOOLEAN, WC_BYTES)
SETTER(Float64, WC_BEFORE_END | WC_BETWEEN, WC_REAL, WC_DOUBLES)
SETTER(Int64, WC_BEFORE_END, WC_ENUMERATION, WC_INT64S)
SETTER(Boolean, WC_BEFORE_END, WC_BOOLEAN, WC_BYTES)

/* Types of which there are no variables: nothing asked is nothing wrong. */
static fmi3Status none_of(fmi3Instance instance, const char *function, size_t n) {
    wc_instance *c = wc_enter(instance, function, WC_ANY_PHASE);
    if (!c) return fmi3Error;
    if (!n) return fmi3OK;
    return (fmi3Status)wc_unsupported(c, function, "this FMU has no variables of this type; modelDescription.xml lists all");
}

#define NO_VARIABLES(type)                                                                                         \
    fmi3Status fmi3Get##type(fmi3Instance instance, const fmi3ValueReference vr[], size_t n, fmi3##type values[], \
                             size_t n_values) {                                                                    \
        UNUSED(vr);                                                                                                \
        UNUSED(values);                                                                                            \
        return none_of(instance, "fmi3Get" #type, n | n_values);                                                   \
    }                                                                                                              \
    fmi3Status fmi3Set##type(fmi3Instance instance, const fmi3ValueReference vr[], size_t n,                      \
                             const fmi3##type values[], size_t n_values) {                                         \
        UNUSED(vr);                                                                                                \
        UNUSED(values);                                                                                            \
        return none_of(instance, "fmi3Set" #type, n | n_values);                                                   \
    }

NO_VARIABLES(Float32)
NO_VARIABLES(Int8)
NO_VARIABLES(UInt8)
NO_VARIABLES(Int16)
NO_VARIABLES(UInt16)
NO_VARIABLES(Int32)
NO_VARIABLES(UInt32)
NO_VARIABLES(UInt64)
NO_VARIABLES(String)

fmi3Status fmi3GetBinary(fmi3Instance instance, const fmi3ValueReference vr[], size_t n, size_t sizes[],
                         fmi3Binary values[], size_t n_values) {
    UNUSED(vr);
    UNUSED(sizes);
    UNUSED(values);
    return none_of(instance, "fmi3GetBinary", n | n_values);
}

fmi3Status fmi3SetBinary(fmi3Instance instance, const fmi3ValueReference vr[], size_t n, const size_t sizes[],
                         const fmi3Binary values[], size_t n_values) {
    UNUSED(vr);
    UNUSED(sizes);
    UNUSED(values);
    return none_of(instance, "fmi3SetBinary", n | n_values);
}

/* ---- clocks, configuration, dependencies: this FMU has none that could change ---- */

#define NO_CLOCKS(function, ...)                                                                                   \
    fmi3Status fmi3##function(fmi3Instance instance, const fmi3ValueReference vr[], size_t n, __VA_ARGS__) {      \
        UNUSED(vr);                                                                                                \
        return none_of(instance, "fmi3" #function, n);                                                             \
    }

#if defined(__GNUC__)
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-parameter"
#endif
NO_CLOCKS(GetClock, fmi3Clock values[])
NO_CLOCKS(SetClock, const fmi3Clock values[])
NO_CLOCKS(GetIntervalDecimal, fmi3Float64 intervals[], fmi3IntervalQualifier qualifiers[])
NO_CLOCKS(GetIntervalFraction, fmi3UInt64 counters[], fmi3UInt64 resolutions[], fmi3IntervalQualifier qualifiers[])
NO_CLOCKS(GetShiftDecimal, fmi3Float64 shifts[])
NO_CLOCKS(GetShiftFraction, fmi3UInt64 counters[], fmi3UInt64 resolutions[])
NO_CLOCKS(SetIntervalDecimal, const fmi3Float64 intervals[])
NO_CLOCKS(SetIntervalFraction, const fmi3UInt64 counters[], const fmi3UInt64 resolutions[])
NO_CLOCKS(SetShiftDecimal, const fmi3Float64 shifts[])
NO_CLOCKS(SetShiftFraction, const fmi3UInt64 counters[], const fmi3UInt64 resolutions[])
#if defined(__GNUC__)
#pragma GCC diagnostic pop
#endif

fmi3Status fmi3ActivateModelPartition(fmi3Instance instance, fmi3ValueReference clock, fmi3Float64 time) {
    UNUSED(clock);
    UNUSED(time);
    return (fmi3Status)wc_unsupported(instance, "fmi3ActivateModelPartition", "this FMU has no Scheduled Execution");
}

static const char NO_STRUCTURE[] = "this FMU has no structural parameters; set parameters before or in initialization mode";

fmi3Status fmi3EnterConfigurationMode(fmi3Instance instance) {
    return (fmi3Status)wc_unsupported(instance, "fmi3EnterConfigurationMode", NO_STRUCTURE);
}

fmi3Status fmi3ExitConfigurationMode(fmi3Instance instance) {
    return (fmi3Status)wc_unsupported(instance, "fmi3ExitConfigurationMode", NO_STRUCTURE);
}

static const char SCALARS[] = "no variable is an array (providesPerElementDependencies is false); read ModelStructure";

fmi3Status fmi3GetNumberOfVariableDependencies(fmi3Instance instance, fmi3ValueReference vr, size_t *n) {
    UNUSED(vr);
    UNUSED(n);
    return (fmi3Status)wc_unsupported(instance, "fmi3GetNumberOfVariableDependencies", SCALARS);
}

fmi3Status fmi3GetVariableDependencies(fmi3Instance instance, fmi3ValueReference dependent, size_t dependent_elements[],
                                       fmi3ValueReference independents[], size_t independent_elements[],
                                       fmi3DependencyKind kinds[], size_t n) {
    UNUSED(dependent);
    UNUSED(dependent_elements);
    UNUSED(independents);
    UNUSED(independent_elements);
    UNUSED(kinds);
    UNUSED(n);
    return (fmi3Status)wc_unsupported(instance, "fmi3GetVariableDependencies", SCALARS);
}

/* ---- saved states ---- */

#define NOT_BETWEEN (WC_ANY_PHASE & ~WC_BETWEEN)

fmi3Status fmi3GetFMUState(fmi3Instance instance, fmi3FMUState *state) {
    WHERE3("fmi3GetFMUState", NOT_BETWEEN, wc_get_state(c, "fmi3GetFMUState", state));
}

fmi3Status fmi3SetFMUState(fmi3Instance instance, fmi3FMUState state) {
    WHERE3("fmi3SetFMUState", NOT_BETWEEN, wc_set_state(c, "fmi3SetFMUState", state));
}

fmi3Status fmi3FreeFMUState(fmi3Instance instance, fmi3FMUState *state) {
    WHERE3("fmi3FreeFMUState", NOT_BETWEEN, wc_free_state(state));
}

fmi3Status fmi3SerializedFMUStateSize(fmi3Instance instance, fmi3FMUState state, size_t *size) {
    WHERE3("fmi3SerializedFMUStateSize", NOT_BETWEEN, wc_state_size(c, "fmi3SerializedFMUStateSize", state, size));
}

fmi3Status fmi3SerializeFMUState(fmi3Instance instance, fmi3FMUState state, fmi3Byte bytes[], size_t size) {
    WHERE3("fmi3SerializeFMUState", NOT_BETWEEN, wc_serialize(c, "fmi3SerializeFMUState", state, bytes, size));
}

fmi3Status fmi3DeserializeFMUState(fmi3Instance instance, const fmi3Byte bytes[], size_t size, fmi3FMUState *state) {
    WHERE3("fmi3DeserializeFMUState", NOT_BETWEEN, wc_deserialize(c, "fmi3DeserializeFMUState", bytes, size, state));
}

/* ---- derivatives ---- */

#define DIFFERENTIABLE (WC_INITIALIZING | WC_RUNNING | WC_BETWEEN | WC_TERMINATED)

fmi3Status fmi3GetDirectionalDerivative(fmi3Instance instance, const fmi3ValueReference unknowns[], size_t n_unknowns,
                                        const fmi3ValueReference knowns[], size_t n_knowns, const fmi3Float64 seed[],
                                        size_t n_seed, fmi3Float64 sensitivity[], size_t n_sensitivity) {
    static const char *const function = "fmi3GetDirectionalDerivative";
    wc_instance *c = wc_enter(instance, function, DIFFERENTIABLE);
    if (!c) return fmi3Error;
    if (n_seed != n_knowns) return wrong_count(c, function, n_knowns, n_seed);
    if (n_sensitivity != n_unknowns) return wrong_count(c, function, n_unknowns, n_sensitivity);
    return (fmi3Status)wc_directional(c, function, unknowns, n_unknowns, knowns, n_knowns, seed, sensitivity);
}

fmi3Status fmi3GetAdjointDerivative(fmi3Instance instance, const fmi3ValueReference unknowns[], size_t n_unknowns,
                                    const fmi3ValueReference knowns[], size_t n_knowns, const fmi3Float64 seed[],
                                    size_t n_seed, fmi3Float64 sensitivity[], size_t n_sensitivity) {
    static const char *const function = "fmi3GetAdjointDerivative";
    wc_instance *c = wc_enter(instance, function, DIFFERENTIABLE);
    if (!c) return fmi3Error;
    if (n_seed != n_unknowns) return wrong_count(c, function, n_unknowns, n_seed);
    if (n_sensitivity != n_knowns) return wrong_count(c, function, n_knowns, n_sensitivity);
    return (fmi3Status)wc_adjoint(c, function, unknowns, n_unknowns, knowns, n_knowns, seed, sensitivity);
}

fmi3Status fmi3GetOutputDerivatives(fmi3Instance instance, const fmi3ValueReference vr[], size_t n,
                                    const fmi3Int32 orders[], fmi3Float64 values[], size_t n_values) {
    static const char *const function = "fmi3GetOutputDerivatives";
    wc_instance *c = wc_enter(instance, function, WC_STEPPING | WC_TERMINATED | WC_FOR_COSIMULATION);
    if (!c) return fmi3Error;
    if (n_values != n) return wrong_count(c, function, n, n_values);
    return (fmi3Status)wc_output_slopes(c, function, vr, n, orders, values);
}

/* ---- Co-Simulation ---- */

fmi3Status fmi3EnterStepMode(fmi3Instance instance) {
    return (fmi3Status)wc_unsupported(instance, "fmi3EnterStepMode",
                                      "Co-Simulation has no event mode here; steps follow fmi3ExitInitializationMode");
}

fmi3Status fmi3DoStep(fmi3Instance instance, fmi3Float64 point, fmi3Float64 h, fmi3Boolean no_set_state,
                      fmi3Boolean *event_needed, fmi3Boolean *terminate, fmi3Boolean *early_return,
                      fmi3Float64 *last_time) {
    UNUSED(no_set_state);
    wc_instance *c = wc_enter(instance, "fmi3DoStep", WC_STEPPING);
    if (!c) return fmi3Error;
    if (!event_needed || !terminate || !early_return || !last_time) {
        return (fmi3Status)wc_missing(c, "fmi3DoStep", "one of the results");
    }
    wc_result result = wc_do_step(c, "fmi3DoStep", point, h);
    *event_needed = *terminate = fmi3False;
    *early_return = result == WC_DONE && c->now.time < point + h;
    *last_time = c->now.time;
    return (fmi3Status)result;
}

/* ---- Model Exchange ---- */

fmi3Status fmi3EnterEventMode(fmi3Instance instance) {
    wc_instance *c = wc_enter(instance, "fmi3EnterEventMode", WC_CONTINUOUS);
    if (!c) return fmi3Error;
    c->now.phase = WC_EVENT;
    return fmi3OK;
}

fmi3Status fmi3EvaluateDiscreteStates(fmi3Instance instance) {
    return (fmi3Status)wc_unsupported(instance, "fmi3EvaluateDiscreteStates",
                                      "this FMU does not provide it (providesEvaluateDiscreteStates is false); call "
                                      "fmi3UpdateDiscreteStates");
}

fmi3Status fmi3UpdateDiscreteStates(fmi3Instance instance, fmi3Boolean *need_update, fmi3Boolean *terminate,
                                    fmi3Boolean *nominals_changed, fmi3Boolean *values_changed,
                                    fmi3Boolean *next_time_defined, fmi3Float64 *next_time) {
    static const char *const function = "fmi3UpdateDiscreteStates";
    wc_instance *c = wc_enter(instance, function, WC_EVENT);
    if (!c) return fmi3Error;
    if (!need_update || !terminate || !nominals_changed || !values_changed || !next_time_defined || !next_time) {
        return (fmi3Status)wc_missing(c, function, "one of the results");
    }
    int jumped = 0;
    wc_result result = wc_update_discrete(c, function, &jumped);
    *need_update = *terminate = *nominals_changed = *next_time_defined = fmi3False;
    *values_changed = jumped;
    return (fmi3Status)result;
}

fmi3Status fmi3EnterContinuousTimeMode(fmi3Instance instance) {
    WHERE3("fmi3EnterContinuousTimeMode", WC_EVENT, wc_enter_continuous(c, "fmi3EnterContinuousTimeMode"));
}

fmi3Status fmi3CompletedIntegratorStep(fmi3Instance instance, fmi3Boolean no_set_state, fmi3Boolean *enter_event_mode,
                                       fmi3Boolean *terminate) {
    UNUSED(no_set_state);
    wc_instance *c = wc_enter(instance, "fmi3CompletedIntegratorStep", WC_CONTINUOUS);
    if (!c) return fmi3Error;
    if (!enter_event_mode || !terminate) {
        return (fmi3Status)wc_missing(c, "fmi3CompletedIntegratorStep", "enterEventMode or terminateSimulation");
    }
    *enter_event_mode = *terminate = fmi3False;
    return (fmi3Status)wc_complete_step(c, "fmi3CompletedIntegratorStep");
}

fmi3Status fmi3SetTime(fmi3Instance instance, fmi3Float64 time) {
    WHERE3("fmi3SetTime", WC_EVENT | WC_CONTINUOUS, wc_set_time(c, "fmi3SetTime", time));
}

fmi3Status fmi3SetContinuousStates(fmi3Instance instance, const fmi3Float64 x[], size_t n) {
    WHERE3("fmi3SetContinuousStates", WC_CONTINUOUS, wc_set_states(c, "fmi3SetContinuousStates", x, n));
}

fmi3Status fmi3GetContinuousStates(fmi3Instance instance, fmi3Float64 x[], size_t n) {
    WHERE3("fmi3GetContinuousStates", WC_EVALUATION, wc_get_states(c, "fmi3GetContinuousStates", x, n));
}

fmi3Status fmi3GetContinuousStateDerivatives(fmi3Instance instance, fmi3Float64 derivatives[], size_t n) {
    WHERE3("fmi3GetContinuousStateDerivatives", WC_EVALUATION,
          wc_get_rates(c, "fmi3GetContinuousStateDerivatives", derivatives, n));
}

fmi3Status fmi3GetEventIndicators(fmi3Instance instance, fmi3Float64 indicators[], size_t n) {
    WHERE3("fmi3GetEventIndicators", WC_EVALUATION, wc_get_crossings(c, "fmi3GetEventIndicators", indicators, n));
}

fmi3Status fmi3GetNominalsOfContinuousStates(fmi3Instance instance, fmi3Float64 nominals[], size_t n) {
    WHERE3("fmi3GetNominalsOfContinuousStates", WC_EVALUATION,
          wc_get_nominals(c, "fmi3GetNominalsOfContinuousStates", nominals, n));
}

static fmi3Status count(wc_instance *c, const char *function, size_t *n, int number) {
    if (!n) return (fmi3Status)wc_missing(c, function, "the number");
    *n = (size_t)number;
    return fmi3OK;
}

fmi3Status fmi3GetNumberOfEventIndicators(fmi3Instance instance, size_t *n) {
    WHERE3("fmi3GetNumberOfEventIndicators", WC_ANY_PHASE | WC_FOR_EXCHANGE,
          count(c, "fmi3GetNumberOfEventIndicators", n, model->crossings));
}

fmi3Status fmi3GetNumberOfContinuousStates(fmi3Instance instance, size_t *n) {
    WHERE3("fmi3GetNumberOfContinuousStates", WC_ANY_PHASE | WC_FOR_EXCHANGE,
          count(c, "fmi3GetNumberOfContinuousStates", n, model->states));
}
