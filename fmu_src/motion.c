#include <math.h>
#include <string.h>

#include "instance.h"

#define SNAP 1e-6 /* of the grid: this near a grid point is on it, as in advance.c */

static const char *why(wc_status status) {
    switch (status) {
    case WC_NOT_FINITE: return "the equations give NaN or infinity";
    case WC_STEP_TOO_SMALL: return "no internal step is short enough for the tolerance, or too many would be needed";
    default: return "the algebraic equations have no solution nearby";
    }
}

/* ---- start ---- */

wc_result wc_set_up(wc_instance *c, const char *function, int has_tolerance, double tolerance, double start, int has_stop,
                    double stop) {
    if (!isfinite(start) || (has_stop && !(stop >= start))) {
        wc_say(c, WC_LOG_ERROR, "%s: start %s s and stop %s s are no span of time; give finite times, the stop not before "
               "the start", function, wc_number(start).text, wc_number(has_stop ? stop : INFINITY).text);
        return WC_FAILED;
    }
    if (has_tolerance && !(tolerance > 0)) {
        wc_say(c, WC_LOG_ERROR, "%s: a tolerance of %s is not positive; give one, e.g. 1e-7", function,
               wc_number(tolerance).text);
        return WC_FAILED;
    }
    wc_saved *s = &c->now;
    s->tolerance = !has_tolerance ? model->tolerance : fmin(fmax(tolerance, WC_LEAST_TOLERANCE), WC_MOST_TOLERANCE);
    s->start_time = s->time = start;
    s->has_stop = has_stop ? 1 : 0;
    s->stop_time = has_stop ? stop : 0;
    if (s->interface == WC_COSIMULATION) {
        wc_say(c, WC_LOG_MODEL, "starts at t = %.9g s, tolerance %g, internal steps of at most %g s", start, s->tolerance,
               model->grid);
    } else {
        wc_say(c, WC_LOG_MODEL, "starts at t = %.9g s with %d continuous states", start, model->states);
    }
    return WC_DONE;
}

wc_result wc_leave_initialization(wc_instance *c, const char *function) {
    wc_result result = wc_settle(c, function);
    if (result == WC_DONE) c->now.phase = c->now.interface == WC_COSIMULATION ? WC_STEPPING : WC_EVENT;
    return result;
}

/* ---- up to date ---- */

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
        /* An integrator that tried too much may try less. */
        int tried = c->now.phase == WC_CONTINUOUS;
        wc_say(c, tried ? WC_LOG_DISCARD : WC_LOG_ERROR, "%s: at t = %.9g s %s; change the inputs, parameters or %s",
               function, c->now.time, why(status), tried ? "states" : "start values");
        return tried ? WC_DISCARDED : WC_FAILED;
    }
    memcpy(c->now.x, x, sizeof x);
    c->now.restart = c->now.stale = 0;
    c->y_valid = c->rate_valid = 0;
    return WC_DONE;
}

wc_result wc_refresh_outputs(wc_instance *c, const char *function) {
    if (c->y_valid) return WC_DONE;
    wc_result result = wc_settle(c, function);
    if (result != WC_DONE) return result;
    wc_output(wc_kernel_of(c), c->now.p, c->now.w, c->now.x, c->y);
    c->y_valid = 1;
    return WC_DONE;
}

wc_result wc_refresh_rates(wc_instance *c, const char *function) {
    if (c->rate_valid) return WC_DONE;
    wc_result result = wc_settle(c, function);
    if (result != WC_DONE) return result;
    const double *arg[] = {c->now.x, c->now.w, c->now.p};
    double *res[] = {c->rate, c->z};
    wc_kernel_of(c)->rate(arg, res, 0, 0, 0);
    c->rate_valid = 1;
    return WC_DONE;
}

/* Says, once, that an input is given and moves nothing. */
static void tell_idle(wc_instance *c) {
    for (int i = 0; i < model->idles; i++) {
        const wc_variable *v = &model->variable[model->idle[i].input], *of = &model->variable[model->idle[i].parameter];
        unsigned bit = 1u << (model->watches + i);
        if (c->warned & bit || c->now.w[v->index] == 0 || c->now.p[of->index] != 0) continue;
        c->warned |= bit;
        wc_say(c, WC_LOG_WARNING, "t = %.9g s: %s = %s moves nothing while %s is %s; set %s as well", c->now.time, v->name,
               wc_valued(v, c->now.w[v->index]).text, of->name, wc_valued(of, 0).text, of->name);
    }
}

/* Says, once, where the model has left the range in which it holds, or an input does nothing. */
static void watch(wc_instance *c) {
    tell_idle(c);
    const int law = wc_law_of(c);
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
                       wc_valued(v, c->y[v->index]).text, wc_valued(v, m->limits[law]).text, m->meaning);
            }
            break;
        }
    }
}

/* ---- Co-Simulation ---- */

static const wc_variable *input(int index) {
    for (int i = 0; i < model->variables; i++) {
        const wc_variable *v = &model->variable[i];
        if (v->kind == WC_INPUT && v->index == index) return v;
    }
    return 0;
}

/* Inputs at the end of a step over which they go with their slopes, as far as their bounds. */
static void inputs_after(wc_instance *c, double h, double *w1) {
    const int inputs = wc_kernel_of(c)->inputs;
    memcpy(w1, c->now.w, sizeof(double) * (size_t)inputs);
    for (int i = 0; i < inputs; i++) {
        if (c->now.slope[i] == 0) continue;
        w1[i] = wc_within(c, input(i), c->now.w[i] + c->now.slope[i] * h);
    }
}

static wc_result refuse_step(const wc_instance *c, const char *function, double point, double h) {
    const wc_saved *s = &c->now;
    double slack = 1e-9 * (1 + fabs(s->time));
    if (!(h > 0) || !isfinite(h)) {
        wc_say(c, WC_LOG_DISCARD, "%s: a step of %s s is not a positive finite time; the simulation stays at t = %.9g s",
               function, wc_number(h).text, s->time);
        return WC_DISCARDED;
    }
    if (!(fabs(point - s->time) <= slack)) {
        wc_say(c, WC_LOG_DISCARD, "%s: the step starts at %s s but the simulation is at t = %.9g s; start it there or "
               "restore a state", function, wc_number(point).text, s->time);
        return WC_DISCARDED;
    }
    if (s->elapsed + h > WC_LONGEST) {
        wc_say(c, WC_LOG_DISCARD, "%s: the step would end %s s after the start; the longest run is %g s", function,
               wc_number(s->elapsed + h).text, WC_LONGEST);
        return WC_DISCARDED;
    }
    if (s->has_stop && point + h > s->stop_time + slack) {
        wc_say(c, WC_LOG_ERROR, "%s: the step ends at %.9g s, after the stop time %.9g s; give a later stop time or none",
               function, point + h, s->stop_time);
        return WC_FAILED;
    }
    return WC_DONE;
}

/* One stretch of length h, to the time `to`. */
static wc_result go_to(wc_instance *c, const char *function, double to, double h) {
    wc_saved *s = &c->now;
    const wc_kernel *k = wc_kernel_of(c);
    double w1[WC_MAX_INPUTS];
    wc_result result = wc_settle(c, function);
    if (result != WC_DONE) return result;
    inputs_after(c, h, w1);
    double added = h - s->lost, elapsed = s->elapsed + added;
    wc_accuracy accuracy = {s->tolerance, model->grid};
    wc_status status = wc_advance(k, s->p, accuracy, s->elapsed, elapsed, s->w, w1, s->x, 0);
    if (status != WC_OK) {
        wc_say(c, WC_LOG_ERROR, "%s: between t = %.9g s and %.9g s %s; the simulation stays at the first, change inputs or "
               "parameters, restore a state or reset", function, s->time, to, why(status));
        return WC_FAILED;
    }
    s->lost = (elapsed - s->elapsed) - added;
    s->elapsed = elapsed;
    s->time = to;
    memcpy(s->w, w1, sizeof(double) * (size_t)k->inputs);
    c->y_valid = c->rate_valid = 0;
    return WC_DONE;
}

/* The time of the next grid point, or `end` where that comes first. */
static double next_stop(const wc_saved *s, double end) {
    if (!(model->grid > 0)) return end;
    double next = (floor(s->elapsed / model->grid + SNAP) + 1) * model->grid - s->elapsed + s->time;
    return next > s->time && next < end - SNAP * model->grid ? next : end; /* far from zero a time may not move */
}

/* To `end` from grid point to grid point, and at each the importer may look, set inputs, or ask to stop. */
static wc_result go_with_pauses(wc_instance *c, const char *function, double end) {
    wc_saved before = c->now;
    while (c->now.time < end) {
        double to = next_stop(&c->now, end);
        wc_result result = go_to(c, function, to, to - c->now.time);
        if (result != WC_DONE) {
            c->now = before;
            c->y_valid = c->rate_valid = 0;
            return result;
        }
        if (to == end) break;
        double wanted = end;
        c->now.phase = WC_BETWEEN;
        c->pause(c->host, to, &wanted);
        c->now.phase = WC_STEPPING;
        if (wanted < end) end = wanted > to ? wanted : to;
    }
    return WC_DONE;
}

wc_result wc_do_step(wc_instance *c, const char *function, double point, double h) {
    wc_saved *s = &c->now;
    wc_result result = refuse_step(c, function, point, h);
    if (result != WC_DONE) return result;
    result = c->pause ? go_with_pauses(c, function, point + h) : go_to(c, function, point + h, h);
    if (result != WC_DONE) return result;
    memcpy(s->last_slope, s->slope, sizeof s->slope);
    memset(s->slope, 0, sizeof s->slope);
    result = wc_refresh_outputs(c, function);
    watch(c);
    return result;
}

/* ---- Model Exchange ---- */

static wc_result wrong_size(const wc_instance *c, const char *function, const char *what, size_t n, int right) {
    wc_say(c, WC_LOG_ERROR, "%s: this FMU has %d %s, not %lu; give an array of that size", function, right, what,
           (unsigned long)n);
    return WC_FAILED;
}

static wc_result refuse_array(const wc_instance *c, const char *function, const void *array, size_t n) {
    if (n != (size_t)model->states) return wrong_size(c, function, "continuous states", n, model->states);
    return n && !array ? wc_missing(c, function, "the array of states") : WC_DONE;
}

wc_result wc_set_time(wc_instance *c, const char *function, double time) {
    if (!isfinite(time)) {
        wc_say(c, WC_LOG_DISCARD, "%s: %s s is no time; the simulation stays at t = %.9g s", function,
               wc_number(time).text, c->now.time);
        return WC_DISCARDED;
    }
    c->now.time = time;
    return WC_DONE;
}

wc_result wc_set_states(wc_instance *c, const char *function, const double *x, size_t n) {
    wc_result result = refuse_array(c, function, x, n);
    if (result != WC_DONE) return result;
    for (size_t i = 0; i < n; i++) {
        if (isfinite(x[i])) continue;
        wc_say(c, WC_LOG_DISCARD, "%s: %s = %s is not a finite number; the old states stay", function,
               model->variable[model->state[i].variable].name, wc_number(x[i]).text);
        return WC_DISCARDED;
    }
    for (size_t i = 0; i < n; i++) c->now.x[model->state[i].place] = x[i];
    c->now.stale = 1;
    c->y_valid = c->rate_valid = 0;
    return WC_DONE;
}

wc_result wc_get_states(wc_instance *c, const char *function, double *x, size_t n) {
    wc_result result = refuse_array(c, function, x, n);
    if (result == WC_DONE && c->now.restart) result = wc_settle(c, function);
    if (result != WC_DONE) return result;
    for (size_t i = 0; i < n; i++) x[i] = c->now.x[model->state[i].place];
    return WC_DONE;
}

wc_result wc_get_rates(wc_instance *c, const char *function, double *rate, size_t n) {
    wc_result result = refuse_array(c, function, rate, n);
    if (result == WC_DONE) result = wc_refresh_rates(c, function);
    if (result != WC_DONE) return result;
    for (size_t i = 0; i < n; i++) rate[i] = c->rate[model->state[i].place];
    return WC_DONE;
}

wc_result wc_get_nominals(wc_instance *c, const char *function, double *nominal, size_t n) {
    wc_result result = refuse_array(c, function, nominal, n);
    if (result != WC_DONE) return result;
    for (size_t i = 0; i < n; i++) nominal[i] = model->state[i].nominal;
    return WC_DONE;
}

wc_result wc_get_crossings(wc_instance *c, const char *function, double *z, size_t n) {
    if (n != (size_t)model->crossings) return wrong_size(c, function, "event indicators", n, model->crossings);
    if (n && !z) return wc_missing(c, function, "eventIndicators");
    wc_result result = wc_refresh_rates(c, function);
    if (result != WC_DONE) return result;
    memcpy(z, c->z, sizeof(double) * n);
    return WC_DONE;
}

wc_result wc_enter_continuous(wc_instance *c, const char *function) {
    wc_result result = wc_refresh_outputs(c, function);
    if (result != WC_DONE) return result;
    for (int i = 0; i < model->crossings; i++) c->now.held[i] = c->y[model->crossing[i]];
    c->now.phase = WC_CONTINUOUS;
    return WC_DONE;
}

wc_result wc_complete_step(wc_instance *c, const char *function) {
    wc_result result = wc_refresh_outputs(c, function);
    if (result == WC_DONE) watch(c);
    return result;
}

wc_result wc_update_discrete(wc_instance *c, const char *function, int *jumped) {
    wc_result result = wc_settle(c, function);
    if (result != WC_DONE) return result;
    *jumped = c->now.jumped;
    c->now.jumped = 0;
    return WC_DONE;
}
