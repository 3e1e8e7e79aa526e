#include "instance.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#define MAGIC "wcstate1"

static const wc_model *const model = &wc_the_model;

/* ---- sentences ---- */

void wc_say(const wc_instance *c, wc_category category, const char *format, ...) {
    char text[512];
    va_list rest;
    va_start(rest, format);
    vsnprintf(text, sizeof text, format, rest);
    va_end(rest);
    c->log(c->host, category, text);
}

typedef struct {
    char text[64];
} label;

/* A number the same way on every platform. */
static label number(double value) {
    label l;
    if (isnan(value)) {
        strcpy(l.text, "nan");
    } else if (isinf(value)) {
        strcpy(l.text, value > 0 ? "inf" : "-inf");
    } else {
        snprintf(l.text, sizeof l.text, "%.10g", value);
    }
    return l;
}

/* A value as a reader knows it: with its unit, or as the name of a choice. */
static label valued(const wc_variable *v, double value) {
    label l;
    if (v->choices) {
        snprintf(l.text, sizeof l.text, "%d (%.40s)", (int)value, v->choices[(int)value - 1]);
    } else {
        snprintf(l.text, sizeof l.text, "%.30s%s%.20s", number(value).text, strcmp(v->unit, "1") ? " " : "",
                 strcmp(v->unit, "1") ? v->unit : "");
    }
    return l;
}

/* ---- values ---- */

static int law_of(const wc_instance *c) { return model->law < 0 ? 0 : (int)c->now.p[model->law] - 1; }

const wc_kernel *wc_kernel_of(const wc_instance *c) { return model->kernels[law_of(c)]; }

void wc_reset(wc_instance *c) {
    memset(&c->now, 0, sizeof c->now);
    memcpy(c->now.magic, MAGIC, sizeof c->now.magic);
    strncpy(c->now.token, model->token, sizeof c->now.token - 1);
    c->now.tolerance = model->tolerance;
    c->now.phase = WC_INSTANTIATED;
    c->now.restart = 1;
    c->y_valid = 0;
    c->warned = 0;
    for (int i = 0; i < model->variables; i++) {
        const wc_variable *v = &model->variable[i];
        if (v->kind == WC_PARAMETER) c->now.p[v->index] = v->start;
        if (v->kind == WC_INPUT) c->now.w[v->index] = v->start;
    }
}

const wc_variable *wc_find(const wc_instance *c, const char *function, unsigned reference, wc_type type) {
    static const char *const types[] = {"Real", "Integer or Enumeration", "Boolean"};
    if (reference < (unsigned)model->variables && model->variable[reference].type == type) {
        return &model->variable[reference];
    }
    wc_say(c, WC_LOG_ERROR, "%s: no variable of type %s has value reference %u; modelDescription.xml lists them",
           function, types[type], reference);
    return 0;
}

static double value_of(const wc_instance *c, const wc_variable *v) {
    switch (v->kind) {
    case WC_TIME: return c->now.time;
    case WC_PARAMETER: return c->now.p[v->index];
    case WC_INPUT: return c->now.w[v->index];
    default: return c->y[v->index];
    }
}

/* Outputs, where they are not up to date. */
static wc_result refresh(wc_instance *c, const char *function) {
    if (c->y_valid) return WC_DONE;
    wc_result result = wc_settle(c, function);
    if (result != WC_DONE) return result;
    wc_output(wc_kernel_of(c), c->now.p, c->now.w, c->now.x, c->y);
    c->y_valid = 1;
    return WC_DONE;
}

wc_result wc_get(wc_instance *c, const wc_variable *v, double *value) {
    if (v->kind == WC_OUTPUT && !c->y_valid) {
        wc_result result = refresh(c, v->name);
        if (result != WC_DONE) return result;
    }
    *value = value_of(c, v);
    return WC_DONE;
}

static wc_result refuse_value(const wc_instance *c, const wc_variable *v, double value) {
    label old = valued(v, value_of(c, v));
    if (v->choices) {
        char list[200] = "";
        size_t used = 0;
        for (int i = (int)v->min; i <= (int)v->max && used < sizeof list; i++) {
            used += (size_t)snprintf(list + used, sizeof list - used, "%s%d (%s)", i > (int)v->min ? ", " : "", i,
                                     v->choices[i - 1]);
        }
        wc_say(c, WC_LOG_DISCARD, "%s = %s is none of its choices %s; the old value %s stays", v->name,
               number(value).text, list, old.text);
    } else if (!isfinite(value)) {
        wc_say(c, WC_LOG_DISCARD, "%s = %s is not a finite number; the old value %s stays", v->name,
               number(value).text, old.text);
    } else {
        int below = value < v->min;
        wc_say(c, WC_LOG_DISCARD, "%s = %s is %s its %s of %s; the old value %s stays", v->name,
               valued(v, value).text, below ? "below" : "above", below ? "minimum" : "maximum",
               valued(v, below ? v->min : v->max).text, old.text);
    }
    return WC_DISCARDED;
}

wc_result wc_check(const wc_instance *c, const char *function, const wc_variable *v, double value) {
    if (v->kind == WC_OUTPUT || v->kind == WC_TIME) {
        wc_say(c, WC_LOG_ERROR, "%s: %s is %s and cannot be set; set inputs and parameters", function, v->name,
               v->kind == WC_TIME ? "the time" : "an output");
        return WC_FAILED;
    }
    if (v->fixed && !(c->now.phase & (WC_INSTANTIATED | WC_INITIALIZING))) {
        wc_say(c, WC_LOG_ERROR,
               "%s: %s is fixed and the simulation has started; the old value %s stays, set it before "
               "fmi2ExitInitializationMode",
               function, v->name, valued(v, value_of(c, v)).text);
        return WC_FAILED;
    }
    return value >= v->min && value <= v->max && isfinite(value) ? WC_DONE : refuse_value(c, v, value);
}

void wc_set(wc_instance *c, const wc_variable *v, double value) {
    double *place = v->kind == WC_PARAMETER ? &c->now.p[v->index] : &c->now.w[v->index];
    if (*place == value) return; /* no jump */
    *place = value;
    c->y_valid = 0;
    if (c->now.phase & (WC_INSTANTIATED | WC_INITIALIZING)) {
        c->now.restart = 1;
        return;
    }
    c->now.stale = 1;
    for (int i = 0; i < model->jumps; i++) {
        const wc_jump *j = &model->jump[i];
        if (v->kind == WC_PARAMETER && v->index == j->parameter && c->now.p[j->mode] == j->when) {
            c->now.x[j->state] = value;
        }
    }
}

/* ---- time ---- */

static const char *why(wc_status status) {
    switch (status) {
    case WC_NOT_FINITE: return "the equations give NaN or infinity";
    case WC_STEP_TOO_SMALL: return "no internal step is short enough for the tolerance";
    default: return "the algebraic equations have no solution nearby";
    }
}

wc_result wc_settle(wc_instance *c, const char *function) {
    if (!c->now.restart && !c->now.stale) return WC_DONE;
    const wc_kernel *k = wc_kernel_of(c);
    double x[WC_MAX_STATES] = {0};
    memcpy(x, c->now.x, sizeof x);
    wc_status status = (c->now.restart ? wc_start : wc_project)(k, c->now.p, c->now.w, x);
    for (int i = 0; i < k->states && status == WC_OK; i++) {
        if (!isfinite(x[i])) status = WC_NOT_FINITE;
    }
    if (status != WC_OK) {
        wc_say(c, WC_LOG_ERROR, "%s: at t = %.9g s %s; change the inputs, parameters or start values", function,
               c->now.time, why(status));
        return WC_FAILED;
    }
    memcpy(c->now.x, x, sizeof x);
    c->now.restart = c->now.stale = 0;
    c->y_valid = 0;
    return WC_DONE;
}

/* Says, once, where the model has left the range in which it holds. */
static void watch(wc_instance *c) {
    const int law = law_of(c);
    for (int i = 0; i < model->watches; i++) {
        const wc_watch *m = &model->watch[i];
        if (c->warned >> i & 1) continue;
        if (m->guard >= 0 && !(fabs(c->y[m->guard]) > m->guard_limit)) continue;
        for (int j = 0; j < m->count; j++) {
            const wc_variable *v = &model->variable[m->variable + j];
            if (fabs(c->y[v->index]) <= m->limits[law]) continue;
            c->warned |= 1u << i;
            if (v->type == WC_BOOLEAN) {
                wc_say(c, WC_LOG_WARNING, "t = %.9g s: %s is true: %s", c->now.time, v->name, m->meaning);
            } else {
                wc_say(c, WC_LOG_WARNING, "t = %.9g s: %s = %s is beyond %s: %s", c->now.time, v->name,
                       valued(v, c->y[v->index]).text, valued(v, m->limits[law]).text, m->meaning);
            }
            break;
        }
    }
}

static const wc_variable *input(int index) {
    for (int i = 0; i < model->variables; i++) {
        const wc_variable *v = &model->variable[i];
        if (v->kind == WC_INPUT && v->index == index) return v;
    }
    return 0;
}

/* Inputs at the end of a step over which they go with their slopes. */
static wc_result inputs_after(const wc_instance *c, const char *function, double h, double *w1) {
    const int inputs = wc_kernel_of(c)->inputs;
    memcpy(w1, c->now.w, sizeof(double) * (size_t)inputs);
    for (int i = 0; i < inputs; i++) {
        if (c->now.slope[i] == 0) continue;
        const wc_variable *v = input(i);
        double end = c->now.w[i] + c->now.slope[i] * h;
        double past = end > v->max ? end - v->max : v->min - end;
        if (past > 1e-9 * (1 + fabs(end))) { /* less is rounding, and ends at the bound */
            wc_say(c, WC_LOG_DISCARD, "%s: the derivative of %s would take it to %s, outside %.10g to %.10g; give a "
                   "derivative that stays inside", function, v->name, valued(v, end).text, v->min, v->max);
            return WC_DISCARDED;
        }
        w1[i] = end > v->max ? v->max : end < v->min ? v->min : end;
    }
    return WC_DONE;
}

static wc_result refuse_step(const wc_instance *c, const char *function, double point, double h) {
    const wc_saved *s = &c->now;
    double slack = 1e-9 * (1 + fabs(s->time));
    if (!(h > 0) || !isfinite(h)) {
        wc_say(c, WC_LOG_DISCARD, "%s: a step of %s s is not a positive finite time; the chair stays at t = %.9g s",
               function, number(h).text, s->time);
        return WC_DISCARDED;
    }
    if (!(fabs(point - s->time) <= slack)) {
        wc_say(c, WC_LOG_DISCARD, "%s: the step starts at %s s but the chair is at t = %.9g s; start it there or "
               "restore a state", function, number(point).text, s->time);
        return WC_DISCARDED;
    }
    if (s->has_stop && point + h > s->stop_time + slack) {
        wc_say(c, WC_LOG_ERROR, "%s: the step ends at %.9g s, after the stop time %.9g s given to "
               "fmi2SetupExperiment; give a later stop time or none", function, point + h, s->stop_time);
        return WC_FAILED;
    }
    return WC_DONE;
}

wc_result wc_do_step(wc_instance *c, const char *function, double point, double h) {
    wc_saved *s = &c->now;
    const wc_kernel *k = wc_kernel_of(c);
    double w1[WC_MAX_INPUTS];
    wc_result result = refuse_step(c, function, point, h);
    if (result == WC_DONE) result = inputs_after(c, function, h, w1);
    if (result == WC_DONE) result = wc_settle(c, function);
    if (result != WC_DONE) return result;
    double added = h - s->lost, elapsed = s->elapsed + added;
    wc_accuracy accuracy = {s->tolerance, model->grid};
    wc_status status = wc_advance(k, s->p, accuracy, s->elapsed, elapsed, s->w, w1, s->x, 0);
    if (status != WC_OK) {
        wc_say(c, WC_LOG_ERROR, "%s: between t = %.9g s and %.9g s %s; the chair stays at the first, change inputs or "
               "parameters, restore a state or reset", function, s->time, s->time + h, why(status));
        return WC_FAILED;
    }
    s->lost = (elapsed - s->elapsed) - added;
    s->elapsed = elapsed;
    s->time = point + h;
    memcpy(s->w, w1, sizeof(double) * (size_t)k->inputs);
    memset(s->slope, 0, sizeof s->slope);
    wc_output(k, s->p, s->w, s->x, c->y);
    c->y_valid = 1;
    watch(c);
    return WC_DONE;
}

/* ---- derivatives ---- */

wc_result wc_directional(wc_instance *c, const char *function, const double *dw, const double *dp, double *dy) {
    wc_result result = wc_settle(c, function);
    if (result != WC_DONE) return result;
    const wc_kernel *k = wc_kernel_of(c);
    double dx[WC_MAX_STATES] = {0}, dr[WC_MAX_STATES];
    if (c->now.phase & (WC_INSTANTIATED | WC_INITIALIZING)) {
        const double *arg[] = {c->now.p, c->now.w, dp, dw};
        double *res[] = {dx};
        model->start_forward(arg, res, 0, 0, 0);
    } else {
        for (int i = 0; i < model->jumps; i++) {
            const wc_jump *j = &model->jump[i];
            if (c->now.p[j->mode] == j->when) dx[j->state] = dp[j->parameter];
        }
    }
    const double *arg[] = {c->now.x, c->now.w, c->now.p, dx, dw, dp};
    double *res[] = {dy, dr};
    k->forward(arg, res, 0, 0, 0);
    return WC_DONE;
}

/* ---- saved states ---- */

/* FNV-1a over everything behind the checksum. */
static uint64_t checksum(const wc_saved *s) {
    const unsigned char *byte = (const unsigned char *)s + offsetof(wc_saved, tolerance);
    uint64_t hash = 14695981039346656037u;
    for (size_t i = offsetof(wc_saved, tolerance); i < sizeof *s; i++) hash = (hash ^ *byte++) * 1099511628211u;
    return hash;
}

void wc_save(const wc_instance *c, wc_saved *to) {
    memcpy(to, &c->now, sizeof *to);
    to->checksum = checksum(to);
}

wc_result wc_verify(const wc_instance *c, const char *function, const void *bytes, size_t size) {
    wc_saved s;
    const char *fault = 0;
    if (!bytes || size != sizeof s) {
        wc_say(c, WC_LOG_ERROR, "%s: a state of this FMU has %lu bytes, not %lu; give back all that was saved", function,
               (unsigned long)sizeof s, (unsigned long)(bytes ? size : 0));
        return WC_FAILED;
    }
    memcpy(&s, bytes, sizeof s);
    if (memcmp(s.magic, MAGIC, sizeof s.magic)) {
        fault = "the bytes are no saved state of a wheelchair";
    } else if (strncmp(s.token, model->token, sizeof s.token)) {
        fault = "the state was saved by another build of this FMU";
    } else if (s.checksum != checksum(&s)) {
        fault = "the saved state has been altered";
    }
    if (!fault) return WC_DONE;
    wc_say(c, WC_LOG_ERROR, "%s: %s; save one with this FMU", function, fault);
    return WC_FAILED;
}

wc_result wc_restore(wc_instance *c, const char *function, const wc_saved *from) {
    wc_result result = wc_verify(c, function, from, sizeof *from);
    if (result != WC_DONE) return result;
    memcpy(&c->now, from, sizeof c->now);
    c->y_valid = 0;
    return WC_DONE;
}
