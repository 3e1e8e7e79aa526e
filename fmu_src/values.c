#include "instance.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* ---- log ---- */

static const struct {
    const char *name;
    wc_category category;
    int status;
} CATEGORIES[] = {
    {"logStatusWarning", WC_LOG_WARNING, 1},
    {"logStatusDiscard", WC_LOG_DISCARD, 2},
    {"logStatusError", WC_LOG_ERROR, 3},
    {"logModel", WC_LOG_MODEL, 0},
};
#define CATEGORY_COUNT ((int)(sizeof CATEGORIES / sizeof *CATEGORIES))
#define ALL_CATEGORIES (WC_LOG_WARNING | WC_LOG_DISCARD | WC_LOG_ERROR | WC_LOG_MODEL)

void wc_say(const wc_instance *c, wc_category category, const char *format, ...) {
    if (!(c->categories & category)) return;
    char text[512];
    va_list rest;
    va_start(rest, format);
    vsnprintf(text, sizeof text, format, rest);
    va_end(rest);
    for (int i = 0; i < CATEGORY_COUNT; i++) {
        if (CATEGORIES[i].category == category) c->log(c->host, CATEGORIES[i].status, CATEGORIES[i].name, text);
    }
}

wc_result wc_set_logging(wc_instance *c, const char *function, int on, size_t n, const char *const names[]) {
    if (n && !names) return wc_missing(c, function, "categories");
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
            wc_say(c, WC_LOG_ERROR, "%s: no log category \"%.60s\"; known: %s, %s, %s, %s", function,
                   names[i] ? names[i] : "(null)", CATEGORIES[0].name, CATEGORIES[1].name, CATEGORIES[2].name,
                   CATEGORIES[3].name);
            return WC_FAILED;
        }
    }
    c->categories = on ? c->categories | chosen : c->categories & ~chosen;
    return WC_DONE;
}

wc_label wc_number(double value) {
    wc_label l;
    if (isnan(value)) {
        strcpy(l.text, "nan");
    } else if (isinf(value)) {
        strcpy(l.text, value > 0 ? "inf" : "-inf");
    } else {
        snprintf(l.text, sizeof l.text, "%.10g", value);
    }
    return l;
}

wc_label wc_valued(const wc_variable *v, double value) {
    wc_label l;
    if (v->choices) {
        snprintf(l.text, sizeof l.text, "%d (%.40s)", (int)value, v->choices[(int)value - 1]);
    } else {
        snprintf(l.text, sizeof l.text, "%.30s%s%.20s", wc_number(value).text, strcmp(v->unit, "1") ? " " : "",
                 strcmp(v->unit, "1") ? v->unit : "");
    }
    return l;
}

wc_result wc_missing(const wc_instance *c, const char *function, const char *argument) {
    wc_say(c, WC_LOG_ERROR, "%s: %s is a null pointer; give an array", function, argument);
    return WC_FAILED;
}

/* ---- life and phases ---- */

const char *wc_refuse_instance(const char *name, wc_interface interface, const char *token) {
    if (!name || !*name) return "the instance has no name; give one";
    if (interface == WC_MODEL_EXCHANGE && !model->states) return "this FMU is for Co-Simulation only; ask for that";
    if (!token || strcmp(token, model->token)) {
        return "the token (guid) is not this library's; take modelDescription.xml and library from one archive";
    }
    return 0;
}

void wc_begin(wc_instance *c, wc_interface interface, int logging) {
    /* A refusal without its reason helps nobody, so reasons are told even where logging is off. */
    c->categories = logging ? ALL_CATEGORIES : ALL_CATEGORIES & ~(unsigned)WC_LOG_MODEL;
    c->now.interface = interface;
    wc_reset(c);
}

void wc_reset(wc_instance *c) {
    int32_t interface = c->now.interface;
    memset(&c->now, 0, sizeof c->now);
    memcpy(c->now.magic, WC_MAGIC, sizeof c->now.magic);
    strncpy(c->now.token, model->token, sizeof c->now.token - 1);
    c->now.interface = interface;
    c->now.tolerance = model->tolerance;
    c->now.phase = WC_INSTANTIATED;
    c->now.restart = 1;
    c->y_valid = c->rate_valid = 0;
    c->warned = c->clamped = 0;
    for (int i = 0; i < model->variables; i++) {
        const wc_variable *v = &model->variable[i];
        if (v->kind == WC_PARAMETER) c->now.p[v->index] = v->start;
        if (v->kind == WC_INPUT) c->now.w[v->index] = v->start;
    }
}

static const struct {
    wc_phase phase;
    int interfaces;
    const char *name, *when; /* %s: the standard */
} PHASES[] = {
    {WC_INSTANTIATED, 3, "instantiated", "before %sEnterInitializationMode"},
    {WC_INITIALIZING, 3, "initialization mode", "in initialization mode"},
    {WC_STEPPING, WC_COSIMULATION, "stepping", "after %sExitInitializationMode"},
    {WC_BETWEEN, WC_COSIMULATION, "intermediate update", "in an intermediate update"},
    {WC_EVENT, WC_MODEL_EXCHANGE, "event mode", "in event mode"},
    {WC_CONTINUOUS, WC_MODEL_EXCHANGE, "continuous-time mode", "after %sEnterContinuousTimeMode"},
    {WC_TERMINATED, 3, "terminated", "after %sTerminate"},
};

wc_instance *wc_alive(void *instance) {
    wc_instance *c = instance;
    return c && !memcmp(c->now.magic, WC_MAGIC, sizeof c->now.magic) ? c : 0;
}

void wc_end(void *instance) {
    wc_instance *c = wc_alive(instance);
    if (!c) return;
    *(volatile char *)c->now.magic = 0; /* which a compiler that knows free would leave out */
    free(c);
}

wc_instance *wc_enter(void *instance, const char *function, int legal) {
    wc_instance *c = wc_alive(instance);
    if (!c) return 0; /* and nobody to tell */
    int only = legal & WC_FOR_EXCHANGE ? WC_MODEL_EXCHANGE : legal & WC_FOR_COSIMULATION ? WC_COSIMULATION : 0;
    if (c->now.phase & legal && (!only || only == c->now.interface)) return c;
    if (only && only != c->now.interface) legal = 0;
    char when[256] = "";
    const char *now = "";
    for (int i = 0; i < (int)(sizeof PHASES / sizeof *PHASES); i++) {
        if (PHASES[i].phase == (wc_phase)c->now.phase) now = PHASES[i].name;
        if (!(PHASES[i].phase & legal) || !(PHASES[i].interfaces & c->now.interface)) continue;
        size_t used = strlen(when);
        used += (size_t)snprintf(when + used, sizeof when - used, "%s", used ? " or " : "call it ");
        snprintf(when + used, sizeof when - used, PHASES[i].when, c->standard);
    }
    wc_say(c, WC_LOG_ERROR, "%s is not allowed while the FMU is \"%s\"; %s", function, now,
           *when ? when : c->now.interface == WC_COSIMULATION ? "it is for Model Exchange" : "it is for Co-Simulation");
    return 0;
}

wc_result wc_unsupported(void *instance, const char *function, const char *why) {
    wc_instance *c = wc_enter(instance, function, WC_ANY_PHASE);
    if (c) wc_say(c, WC_LOG_ERROR, "%s: %s", function, why);
    return WC_FAILED;
}

/* ---- values ---- */

static int law_by(const double *p) { return model->law < 0 ? 0 : (int)p[model->law] - 1; }

int wc_law_of(const wc_instance *c) { return law_by(c->now.p); }

const wc_kernel *wc_kernel_by(const double *p) { return model->kernels[law_by(p)]; }

const wc_kernel *wc_kernel_of(const wc_instance *c) { return wc_kernel_by(c->now.p); }

const wc_variable *wc_find(const wc_instance *c, const char *function, unsigned reference, wc_type type) {
    static const char *const types[] = {"real number", "enumeration", "Boolean"};
    if (reference < (unsigned)model->variables && model->variable[reference].type == type) {
        return &model->variable[reference];
    }
    wc_say(c, WC_LOG_ERROR, "%s: no %s has value reference %u; modelDescription.xml lists the variables", function,
           types[type], reference);
    return 0;
}

/* What is true or false does not change between events. */
static int held(const wc_instance *c, const wc_variable *v, double *value) {
    if (c->now.phase != WC_CONTINUOUS || v->type != WC_BOOLEAN) return 0;
    for (int i = 0; i < model->crossings; i++) {
        if (model->crossing[i] == v->index) *value = c->now.held[i];
    }
    return 1;
}

/* A value, after bringing what it depends on up to date. */
static wc_result get(wc_instance *c, const char *function, const wc_variable *v, double *value) {
    wc_result result = WC_DONE;
    switch (v->kind) {
    case WC_TIME: *value = c->now.time; break;
    case WC_PARAMETER: *value = c->now.p[v->index]; break;
    case WC_INPUT: *value = c->now.w[v->index]; break;
    case WC_OUTPUT:
        if (held(c, v, value)) break;
        result = wc_refresh_outputs(c, function);
        *value = c->y[v->index];
        break;
    default:
        result = wc_refresh_rates(c, function);
        *value = v->kind == WC_DERIVATIVE ? c->rate[v->index] : c->z[v->index];
    }
    return result;
}

static wc_result refuse_value(const wc_instance *c, const wc_variable *v, double value, double old_value) {
    wc_label old = wc_valued(v, old_value);
    if (v->choices) {
        char list[200] = "";
        size_t used = 0;
        for (int i = (int)v->min; i <= (int)v->max && used < sizeof list; i++) {
            used += (size_t)snprintf(list + used, sizeof list - used, "%s%d (%s)", i > (int)v->min ? ", " : "", i,
                                     v->choices[i - 1]);
        }
        wc_say(c, WC_LOG_DISCARD, "%s = %s is none of its choices %s; the old value %s stays", v->name,
               wc_number(value).text, list, old.text);
    } else if (!isfinite(value)) {
        wc_say(c, WC_LOG_DISCARD, "%s = %s is not a finite number; the old value %s stays", v->name,
               wc_number(value).text, old.text);
    } else {
        int below = value < v->min;
        wc_say(c, WC_LOG_DISCARD, "%s = %s is %s its %s of %s; the old value %s stays", v->name,
               wc_valued(v, value).text, below ? "below" : "above", below ? "minimum" : "maximum",
               wc_valued(v, below ? v->min : v->max).text, old.text);
    }
    return WC_DISCARDED;
}

int wc_same_states(const wc_kernel *k, const double *p) {
    double mass[WC_MAX_STATES];
    const double *arg[] = {p};
    double *res[] = {mass};
    k->mass(arg, res, 0, 0, 0);
    int differential = 0, state = 0;
    for (int i = 0; i < k->states; i++) differential += mass[i] != 0;
    for (int i = 0; i < model->states; i++) state += mass[model->state[i].place] != 0;
    return differential == model->states && state == model->states;
}

/* In Model Exchange an algebraic row may not become a differential one, nor the other way. */
static wc_result refuse_new_states(const wc_instance *c, const wc_variable *v, double value) {
    double p[WC_MAX_PARAMETERS];
    memcpy(p, c->now.p, sizeof p);
    p[v->index] = value;
    if (wc_same_states(wc_kernel_of(c), p)) return WC_DONE;
    wc_say(c, WC_LOG_DISCARD, "%s = %s would change the number of continuous states, which Model Exchange fixes when the "
           "FMU is built; build it with such a value, or use Co-Simulation; the old value %s stays", v->name,
           wc_valued(v, value).text, wc_valued(v, c->now.p[v->index]).text);
    return WC_DISCARDED;
}

int wc_possible(const wc_variable *v, double value) {
    return isfinite(value) && value >= v->min && value <= v->max && (!v->choices || value == floor(value));
}

/* May this variable be given this value now? Says why not. */
static wc_result check(const wc_instance *c, const char *function, const wc_variable *v, double value) {
    const wc_saved *s = &c->now;
    if (v->kind != WC_PARAMETER && v->kind != WC_INPUT) {
        static const char *const kinds[] = {"the time", "", "", "an output", "a derivative", "an event indicator"};
        wc_say(c, WC_LOG_ERROR, "%s: %s is %s and cannot be set; set inputs and parameters", function, v->name,
               kinds[v->kind]);
        return WC_FAILED;
    }
    double old = v->kind == WC_PARAMETER ? s->p[v->index] : s->w[v->index];
    if (v->fixed && !(s->phase & (WC_INSTANTIATED | WC_INITIALIZING))) {
        wc_say(c, WC_LOG_ERROR,
               "%s: %s is fixed and the simulation has started; the old value %s stays, set it before "
               "%sExitInitializationMode",
               function, v->name, wc_valued(v, old).text, c->standard);
        return WC_FAILED;
    }
    if (v->kind == WC_PARAMETER && s->phase & (WC_CONTINUOUS | WC_BETWEEN)) {
        wc_say(c, WC_LOG_ERROR, "%s: %s is a parameter, and parameters change at events; the old value %s stays, set it "
               "%s", function, v->name, wc_valued(v, old).text,
               s->phase == WC_BETWEEN ? "between steps" : "in event mode");
        return WC_FAILED;
    }
    if (v->kind == WC_INPUT) return isfinite(value) ? WC_DONE : refuse_value(c, v, value, old);
    if (!wc_possible(v, value)) return refuse_value(c, v, value, old);
    return s->interface == WC_MODEL_EXCHANGE ? refuse_new_states(c, v, value) : WC_DONE;
}

double wc_within(wc_instance *c, const wc_variable *v, double value) {
    if (value >= v->min && value <= v->max) return value;
    double bound = value < v->min ? v->min : v->max, range = v->max - v->min;
    int rounding = fabs(value - bound) <= 1e-9 * (isfinite(range) ? range : 1 + fabs(bound));
    if (rounding || c->clamped >> v->index & 1) return bound;
    c->clamped |= (uint32_t)1 << v->index;
    const char *which = value < v->min ? "minimum" : "maximum";
    wc_say(c, WC_LOG_WARNING, "t = %.9g s: %s = %s is %s its %s of %s; the %s is used instead, now and whenever this input is "
           "out of bounds", c->now.time, v->name, wc_valued(v, value).text, value < v->min ? "below" : "above", which,
           wc_valued(v, bound).text, which);
    return bound;
}

/* Gives a checked value. */
static void set(wc_instance *c, const wc_variable *v, double value) {
    double *place = v->kind == WC_PARAMETER ? &c->now.p[v->index] : &c->now.w[v->index];
    if (*place == value) return; /* no jump */
    *place = value;
    c->y_valid = c->rate_valid = 0;
    if (c->now.phase & (WC_INSTANTIATED | WC_INITIALIZING)) {
        c->now.restart = 1;
        return;
    }
    c->now.stale = 1;
    for (int i = 0; i < model->jumps; i++) {
        const wc_jump *j = &model->jump[i];
        if (v->kind == WC_PARAMETER && v->index == j->parameter && c->now.p[j->mode] == j->when) {
            c->now.x[j->state] = value;
            c->now.jumped = 1;
        }
    }
}

static double value_at(const void *values, wc_array array, size_t i) {
    switch (array) {
    case WC_DOUBLES: return ((const double *)values)[i];
    case WC_INTS: return ((const int *)values)[i];
    case WC_INT64S: return (double)((const int64_t *)values)[i];
    default: return ((const unsigned char *)values)[i] != 0;
    }
}

static void put_at(void *values, wc_array array, size_t i, double value) {
    switch (array) {
    case WC_DOUBLES: ((double *)values)[i] = value; break;
    case WC_INTS: ((int *)values)[i] = (int)value; break;
    case WC_INT64S: ((int64_t *)values)[i] = (int64_t)value; break;
    default: ((unsigned char *)values)[i] = value != 0;
    }
}

wc_result wc_set_all(wc_instance *c, const char *function, const unsigned vr[], size_t n, wc_type type, const void *values,
                     wc_array array) {
    if (n && (!vr || !values)) return wc_missing(c, function, vr ? "values" : "valueReferences");
    for (size_t i = 0; i < n; i++) {
        const wc_variable *v = wc_find(c, function, vr[i], type);
        if (!v) return WC_FAILED;
        wc_result result = check(c, function, v, value_at(values, array, i));
        if (result != WC_DONE) return result;
    }
    for (size_t i = 0; i < n; i++) {
        const wc_variable *v = &model->variable[vr[i]];
        double value = value_at(values, array, i);
        set(c, v, v->kind == WC_INPUT ? wc_within(c, v, value) : value);
    }
    return WC_DONE;
}

wc_result wc_get_all(wc_instance *c, const char *function, const unsigned vr[], size_t n, wc_type type, void *values,
                     wc_array array) {
    if (n && (!vr || !values)) return wc_missing(c, function, vr ? "values" : "valueReferences");
    for (size_t i = 0; i < n; i++) {
        double value = 0;
        /* Some importers read every output as a real number: what is true or false is then 1 or 0. */
        int truth = type == WC_REAL && vr[i] < (unsigned)model->variables && model->variable[vr[i]].type == WC_BOOLEAN;
        const wc_variable *v = wc_find(c, function, vr[i], truth ? WC_BOOLEAN : type);
        if (!v) return WC_FAILED;
        wc_result result = get(c, function, v, &value);
        if (result != WC_DONE) return result;
        put_at(values, array, i, value);
    }
    return WC_DONE;
}
