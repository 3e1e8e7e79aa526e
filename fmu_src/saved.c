#include <string.h>

#include "instance.h"

static const wc_model *const model = &wc_the_model;

/* FNV-1a over everything behind the checksum. */
static uint64_t checksum(const wc_saved *s) {
    const unsigned char *byte = (const unsigned char *)s + offsetof(wc_saved, tolerance);
    uint64_t hash = 14695981039346656037u;
    for (size_t i = offsetof(wc_saved, tolerance); i < sizeof *s; i++) hash = (hash ^ *byte++) * 1099511628211u;
    return hash;
}

static wc_result verify(const wc_instance *c, const char *function, const void *bytes, size_t size) {
    wc_saved s;
    const char *fault = 0;
    if (!bytes || size != sizeof s) {
        wc_say(c, WC_LOG_ERROR, "%s: a state of this FMU has %lu bytes, not %lu; give back all that was saved", function,
               (unsigned long)sizeof s, (unsigned long)(bytes ? size : 0));
        return WC_FAILED;
    }
    memcpy(&s, bytes, sizeof s);
    if (memcmp(s.magic, WC_MAGIC, sizeof s.magic)) {
        fault = "the bytes are no saved state of this kind of FMU";
    } else if (strncmp(s.token, model->token, sizeof s.token)) {
        fault = "the state was saved by another build of this FMU";
    } else if (s.checksum != checksum(&s)) {
        fault = "the saved state has been altered";
    } else if (s.interface != c->now.interface) {
        fault = s.interface == WC_COSIMULATION ? "the state was saved in Co-Simulation, and this is Model Exchange"
                                               : "the state was saved in Model Exchange, and this is Co-Simulation";
    }
    if (!fault) return WC_DONE;
    wc_say(c, WC_LOG_ERROR, "%s: %s; save one with this FMU", function, fault);
    return WC_FAILED;
}

static wc_saved *room(wc_instance *c, const char *function, void **state) {
    if (!*state) *state = c->allocate(1, sizeof(wc_saved));
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

wc_result wc_free_state(wc_instance *c, void **state) {
    if (state && *state) {
        c->release(*state);
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
