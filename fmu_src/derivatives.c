#include <math.h>
#include <string.h>

#include "instance.h"

/* A direction in which states, inputs and parameters change, and what then changes. */
typedef struct {
    double dx[WC_MAX_STATES], dw[WC_MAX_INPUTS], dp[WC_MAX_PARAMETERS];
    double dy[WC_MAX_OUTPUTS], d_rate[WC_MAX_STATES];
} direction;

static int starting(const wc_instance *c) { return (c->now.phase & (WC_INSTANTIATED | WC_INITIALIZING)) != 0; }

/* The state that is this output, or < 0. */
static int state_of(unsigned reference) {
    for (int i = 0; i < model->states; i++) {
        if (model->state[i].variable == (int)reference) return model->state[i].place;
    }
    return -1;
}

/* Where in the direction a known changes; 0, with a sentence, where nothing varies with it. */
static double *place_of(const wc_instance *c, const char *function, direction *d, unsigned reference) {
    const wc_variable *v = wc_find(c, function, reference, WC_REAL);
    if (!v) return 0;
    if (v->kind == WC_INPUT) return &d->dw[v->index];
    if (v->kind == WC_PARAMETER && (!v->fixed || starting(c))) return &d->dp[v->index];
    if (v->kind == WC_OUTPUT && state_of(reference) >= 0 && !starting(c)) return &d->dx[state_of(reference)];
    wc_say(c, WC_LOG_ERROR, "%s: %s cannot change now, so nothing varies with it; give %s", function, v->name,
           starting(c) ? "inputs and parameters" : "inputs, continuous states and tunable parameters");
    return 0;
}

static wc_result refuse_unknowns(const wc_instance *c, const char *function, const unsigned unknown[], size_t n) {
    for (size_t i = 0; i < n; i++) {
        const wc_variable *v = wc_find(c, function, unknown[i], WC_REAL);
        if (!v) return WC_FAILED;
        if (v->kind == WC_OUTPUT || v->kind == WC_DERIVATIVE) continue;
        wc_say(c, WC_LOG_ERROR, "%s: %s is no output; give outputs and derivatives of states as unknowns", function, v->name);
        return WC_FAILED;
    }
    return WC_DONE;
}

static double changed(const direction *d, unsigned unknown) {
    const wc_variable *v = &model->variable[unknown];
    return v->kind == WC_OUTPUT ? d->dy[v->index] : d->d_rate[v->index];
}

/* What changes along a direction, where the instance is settled. */
static void follow(const wc_instance *c, direction *d) {
    if (starting(c)) {
        const double *arg[] = {c->now.p, c->now.w, d->dp, d->dw};
        double *res[] = {d->dx};
        model->start_forward(arg, res, 0, 0, 0);
    } else {
        for (int i = 0; i < model->jumps; i++) {
            const wc_jump *j = &model->jump[i];
            if (c->now.p[j->mode] == j->when) d->dx[j->state] += d->dp[j->parameter];
        }
    }
    const double *arg[] = {c->now.x, c->now.w, c->now.p, d->dx, d->dw, d->dp};
    double *res[] = {d->dy, d->d_rate};
    wc_kernel_of(c)->forward(arg, res, 0, 0, 0);
}

static wc_result refuse_arrays(const wc_instance *c, const char *function, const unsigned unknown[], size_t n_unknown,
                               const unsigned known[], size_t n_known, const double seed[], size_t n_seed,
                               const double out[], size_t n_out) {
    if (n_unknown && !unknown) return wc_missing(c, function, "unknowns");
    if (n_known && !known) return wc_missing(c, function, "knowns");
    if (n_seed && !seed) return wc_missing(c, function, "seed");
    if (n_out && !out) return wc_missing(c, function, "sensitivity");
    return refuse_unknowns(c, function, unknown, n_unknown);
}

wc_result wc_directional(wc_instance *c, const char *function, const unsigned unknown[], size_t n_unknown,
                         const unsigned known[], size_t n_known, const double seed[], double out[]) {
    direction d = {0};
    wc_result result = refuse_arrays(c, function, unknown, n_unknown, known, n_known, seed, n_known, out, n_unknown);
    if (result != WC_DONE) return result;
    for (size_t i = 0; i < n_known; i++) {
        double *place = place_of(c, function, &d, known[i]);
        if (!place) return WC_FAILED;
        *place += seed[i];
    }
    result = wc_settle(c, function);
    if (result != WC_DONE) return result;
    follow(c, &d);
    for (size_t i = 0; i < n_unknown; i++) out[i] = changed(&d, unknown[i]);
    return WC_DONE;
}

wc_result wc_adjoint(wc_instance *c, const char *function, const unsigned unknown[], size_t n_unknown,
                     const unsigned known[], size_t n_known, const double seed[], double out[]) {
    wc_result result = refuse_arrays(c, function, unknown, n_unknown, known, n_known, seed, n_unknown, out, n_known);
    if (result == WC_DONE) result = wc_settle(c, function);
    if (result != WC_DONE) return result;
    for (size_t i = 0; i < n_known; i++) { /* all or none */
        direction d = {0};
        if (!place_of(c, function, &d, known[i])) return WC_FAILED;
    }
    for (size_t i = 0; i < n_known; i++) {
        direction d = {0};
        *place_of(c, function, &d, known[i]) = 1;
        follow(c, &d);
        out[i] = 0;
        for (size_t j = 0; j < n_unknown; j++) out[i] += seed[j] * changed(&d, unknown[j]);
    }
    return WC_DONE;
}

wc_result wc_output_slopes(wc_instance *c, const char *function, const unsigned vr[], size_t n, const int order[],
                           double out[]) {
    if (n && (!vr || !order || !out)) return wc_missing(c, function, !vr ? "vr" : !order ? "order" : "value");
    for (size_t i = 0; i < n; i++) {
        const wc_variable *v = wc_find(c, function, vr[i], WC_REAL);
        if (!v) return WC_FAILED;
        if (v->kind == WC_OUTPUT && order[i] == 1) continue;
        wc_say(c, WC_LOG_ERROR, "%s: %s, order %d: only outputs have a derivative here, and only the first", function, v->name,
               order[i]);
        return WC_FAILED;
    }
    wc_result result = wc_refresh_rates(c, function);
    if (result != WC_DONE) return result;
    direction d = {0};
    memcpy(d.dx, c->rate, sizeof d.dx);
    memcpy(d.dw, c->now.last_slope, sizeof d.dw);
    follow(c, &d);
    for (size_t i = 0; i < n; i++) out[i] = changed(&d, vr[i]);
    return WC_DONE;
}

wc_result wc_input_slopes(wc_instance *c, const char *function, const unsigned vr[], size_t n, const int order[],
                          const double value[]) {
    if (n && (!vr || !order || !value)) return wc_missing(c, function, !vr ? "vr" : !order ? "order" : "value");
    for (size_t i = 0; i < n; i++) {
        const wc_variable *v = wc_find(c, function, vr[i], WC_REAL);
        if (!v) return WC_FAILED;
        if (v->kind != WC_INPUT || order[i] != 1) {
            wc_say(c, WC_LOG_ERROR, "%s: %s, order %d: only inputs take a derivative, and only the first", function, v->name,
                   order[i]);
            return WC_FAILED;
        }
        if (!isfinite(value[i])) {
            wc_say(c, WC_LOG_DISCARD, "%s: the derivative of %s is not a finite number; the old one stays", function,
                   v->name);
            return WC_DISCARDED;
        }
    }
    for (size_t i = 0; i < n; i++) c->now.slope[model->variable[vr[i]].index] = value[i];
    return WC_DONE;
}
