#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "instance.h"

/* FNV-1a over everything behind the checksum. */
static uint64_t checksum(const wc_saved *s) {
    const unsigned char *byte = (const unsigned char *)s + offsetof(wc_saved, tolerance);
    uint64_t hash = 14695981039346656037u;
    for (size_t i = offsetof(wc_saved, tolerance); i < sizeof *s; i++) hash = (hash ^ *byte++) * 1099511628211u;
    return hash;
}

static int all_finite(const double *value, int n) {
    for (int i = 0; i < n; i++) {
        if (!isfinite(value[i])) return 0;
    }
    return 1;
}

static int truth(int32_t value) { return value == 0 || value == 1; }

/* A checksum is no proof: whoever knows how it is made can forge one. So nothing is taken that a run could not have left,
 * least of all what chooses a kernel. */
static int possible(const wc_saved *s) {
    int cosimulation = s->interface == WC_COSIMULATION;
    int phases[] = {WC_INSTANTIATED, WC_INITIALIZING, WC_TERMINATED, cosimulation ? WC_STEPPING : WC_EVENT,
                    cosimulation ? WC_STEPPING : WC_CONTINUOUS};
    int known = 0;
    for (int i = 0; i < (int)(sizeof phases / sizeof *phases); i++) known |= s->phase == phases[i];
    if (!known || !truth(s->has_stop) || !truth(s->restart) || !truth(s->stale) || !truth(s->jumped)) return 0;
    if (!(s->tolerance >= WC_LEAST_TOLERANCE && s->tolerance <= WC_MOST_TOLERANCE) || isnan(s->stop_time)) return 0;
    if (!isfinite(s->start_time) || !isfinite(s->time) || !(fabs(s->lost) <= 1)) return 0;
    if (!(s->elapsed >= 0 && s->elapsed <= WC_LONGEST)) return 0;
    if (!all_finite(s->x, WC_MAX_STATES) || !all_finite(s->held, WC_MAX_CROSSINGS)) return 0;
    if (!all_finite(s->slope, WC_MAX_INPUTS) || !all_finite(s->last_slope, WC_MAX_INPUTS)) return 0;
    for (int i = 0; i < model->variables; i++) {
        const wc_variable *v = &model->variable[i];
        if (v->kind == WC_PARAMETER && !wc_possible(v, s->p[v->index])) return 0;
        if (v->kind == WC_INPUT && !wc_possible(v, s->w[v->index])) return 0;
    }
    return cosimulation || wc_same_states(wc_kernel_by(s->p), s->p);
}

static const char *fault_of(const wc_instance *c, const wc_saved *s) {
    if (s->nothing || memcmp(s->magic, WC_MAGIC, sizeof s->magic)) return "the bytes are no saved state of this kind of FMU";
    if (strncmp(s->token, model->token, sizeof s->token)) return "the state was saved by another build of this FMU";
    if (s->checksum != checksum(s)) return "the saved state has been altered";
    if (s->interface != c->now.interface) {
        return s->interface == WC_COSIMULATION ? "the state was saved in Co-Simulation, and this is Model Exchange"
                                               : "the state was saved in Model Exchange, and this is Co-Simulation";
    }
    return possible(s) ? 0 : "the state holds values that this FMU never has";
}

/* Of the layout before states began with zero, or of another version since? */
static int of_another_version(const unsigned char *bytes, size_t size) {
    const size_t at = offsetof(wc_saved, magic), letters = WC_MAGIC_OF_ANY_VERSION;
    if (size >= letters && !memcmp(bytes, WC_MAGIC, letters)) return 1;
    return size > at + letters && !memcmp(bytes + at, WC_MAGIC, letters) && bytes[at + letters] != WC_MAGIC[letters];
}

static wc_result verify(const wc_instance *c, const char *function, const void *bytes, size_t size) {
    wc_saved s;
    if (bytes && of_another_version(bytes, size)) {
        wc_say(c, WC_LOG_ERROR, "%s: the state has the layout of another version of this FMU; save one with this FMU", function);
        return WC_FAILED;
    }
    if (!bytes || size != sizeof s) {
        wc_say(c, WC_LOG_ERROR, "%s: a state of this FMU has %lu bytes, not %lu; give back all that was saved", function,
               (unsigned long)sizeof s, (unsigned long)(bytes ? size : 0));
        return WC_FAILED;
    }
    memcpy(&s, bytes, sizeof s);
    const char *fault = fault_of(c, &s);
    if (!fault) return WC_DONE;
    wc_say(c, WC_LOG_ERROR, "%s: %s; save one with this FMU", function, fault);
    return WC_FAILED;
}

static wc_saved *room(const wc_instance *c, const char *function, void **state) {
    if (!*state) *state = calloc(1, sizeof(wc_saved));
    if (!*state) wc_say(c, WC_LOG_ERROR, "%s: no memory left; free states that are no longer needed", function);
    return *state;
}

wc_result wc_get_state(wc_instance *c, const char *function, void **state) {
    if (!state) return wc_missing(c, function, "FMUState");
    wc_saved *s = room(c, function, state);
    if (!s) return WC_FAILED;
    memcpy(s, &c->now, sizeof *s);
    s->checksum = checksum(s);
    return WC_DONE;
}

wc_result wc_set_state(wc_instance *c, const char *function, const void *state) {
    if (!state) return wc_missing(c, function, "FMUState");
    wc_result result = verify(c, function, state, sizeof(wc_saved));
    if (result != WC_DONE) return result;
    memcpy(&c->now, state, sizeof c->now);
    c->y_valid = c->rate_valid = 0;
    return WC_DONE;
}

wc_result wc_free_state(void **state) {
    if (state && *state) {
        free(*state);
        *state = 0;
    }
    return WC_DONE;
}

wc_result wc_state_size(wc_instance *c, const char *function, const void *state, size_t *size) {
    if (!state || !size) return wc_missing(c, function, state ? "size" : "FMUState");
    *size = sizeof(wc_saved);
    return WC_DONE;
}

wc_result wc_serialize(wc_instance *c, const char *function, const void *state, void *bytes, size_t size) {
    if (!state || !bytes) return wc_missing(c, function, state ? "serializedState" : "FMUState");
    if (size < sizeof(wc_saved)) {
        wc_say(c, WC_LOG_ERROR, "%s: %lu bytes are too few; give %lu", function, (unsigned long)size,
               (unsigned long)sizeof(wc_saved));
        return WC_FAILED;
    }
    memcpy(bytes, state, sizeof(wc_saved));
    return WC_DONE;
}

wc_result wc_deserialize(wc_instance *c, const char *function, const void *bytes, size_t size, void **state) {
    if (!state) return wc_missing(c, function, "FMUState");
    wc_result result = verify(c, function, bytes, size);
    if (result != WC_DONE) return result;
    wc_saved *s = room(c, function, state);
    if (!s) return WC_FAILED;
    memcpy(s, bytes, sizeof *s);
    return WC_DONE;
}
