/* Calls the FMU's functions at random, in any order, with any arguments that are memory at all.
 *
 *     fuzz TOKEN VARIABLES STATES FIRST_SEED SEEDS
 *
 * Each seed is one life of four instances, two by each version of FMI, of 400 calls. Compiled together with the FMU's
 * sources under a sanitizer, so that a fault stops the program; the last line on stderr names the seed. Every status must be
 * one of OK, Warning, Discard, Error, and whatever happens, a reset instance must afterwards step as a new one does. Among the
 * calls are saved states with forged content and a right checksum; how many were taken and refused is printed.
 *
 * With -DLIBFUZZER -fsanitize=fuzzer each life is an input of libFuzzer's: every eight bytes are the seed of one call, so that
 * lives which reach new code are kept and go on in other ways. TOKEN, VARIABLES and STATES then come from the environment.
 */
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "fmi2Functions.h"
#include "fmi3Functions.h"
#include "instance.h" /* for the layout of saved states */

#define CALLS 400
#define MOST 8

static const char *token;
static unsigned variables, states;
static uint64_t random_state, bad_status, sentences, forgeries_taken, forgeries_refused;

static uint64_t draw(void) { /* xorshift64* */
    random_state ^= random_state >> 12;
    random_state ^= random_state << 25;
    random_state ^= random_state >> 27;
    return random_state * 2685821657736338717u;
}

static unsigned below(unsigned n) { return (unsigned)(draw() >> 33) % n; }

static double number(void) {
    static const double odd[] = {0, -0.0, 1, -1, 0.01, 1e-3, 5e-324, 1e-300, 1e300, -1e300, 1e18, -3};
    switch (below(8)) {
    case 0: return NAN;
    case 1: return below(2) ? INFINITY : -INFINITY;
    case 2: case 3: return odd[below(sizeof odd / sizeof *odd)];
    default: return ((double)(draw() >> 11) / 9007199254740992.0 - 0.5) * (below(2) ? 4 : 400);
    }
}

static unsigned reference(void) { return below(20) ? below(variables) : below(3) ? variables + below(9) : (unsigned)draw(); }

/* The arguments of one call: all arrays are of MOST, counts mostly fit. */
static unsigned vr[MOST], more[MOST];
static double values[MOST], results[64];
static int order[MOST], ints[MOST];
static int64_t wide[MOST];
static bool truth[MOST];

static size_t fill(void) {
    for (int i = 0; i < MOST; i++) {
        vr[i] = reference();
        more[i] = reference();
        values[i] = number();
        order[i] = below(8) ? 1 : (int)draw();
        ints[i] = (int)below(6);
        wide[i] = below(4) ? (int64_t)below(6) : (int64_t)draw();
        truth[i] = below(2);
    }
    return below(MOST + 1);
}

static void check(int status) {
    if (status < 0 || status > 3) bad_status++;
}

static void heard2(fmi2ComponentEnvironment e, fmi2String name, fmi2Status s, fmi2String category, fmi2String text, ...) {
    (void)e, (void)s, (void)category;
    sentences += name && text && *text;
}

static void heard3(fmi3InstanceEnvironment e, fmi3Status s, fmi3String category, fmi3String text) {
    (void)e, (void)s, (void)category;
    sentences += text && *text;
}

static fmi3Instance inside; /* whose intermediate update is running */

static void update(fmi3InstanceEnvironment e, double time, bool set, bool get, bool done, bool may, bool *early, double *until) {
    (void)e, (void)set, (void)get, (void)done, (void)may;
    if (below(50) == 0) {
        *early = true;
        *until = below(2) ? time + 0.0003 : number();
    }
    if (below(50) == 0) {
        size_t n = fill();
        check(fmi3SetFloat64(inside, vr, n, values, n));
        check(fmi3GetFloat64(inside, vr, n, results, n));
        check(fmi3DoStep(inside, time, 0.01, true, &truth[0], &truth[1], &truth[2], results));
        check(fmi3Reset(inside));
    }
}

static double clock_of2(fmi2Component c) {
    unsigned time = 0;
    double t = 0;
    fmi2GetReal(c, &time, 1, &t);
    return t;
}

static fmi2FMUstate kept2;
static fmi3FMUState kept3;
static unsigned char bytes[1 << 14];
static size_t saved2, saved3;

/* ---- forged states ---- */

static int32_t whole(void) { return below(3) ? (int32_t)below(80) - 2 : (int32_t)draw(); }

static double any(void) { return below(2) ? number() : (double)below(9); }

static void forge_once(wc_saved *s) {
    double *times[] = {&s->tolerance, &s->start_time, &s->stop_time, &s->time, &s->elapsed, &s->lost};
    int32_t *words[] = {&s->interface, &s->phase, &s->has_stop, &s->restart, &s->stale, &s->jumped};
    switch (below(10)) {
    case 0: case 1: case 2: s->p[below(WC_MAX_PARAMETERS)] = any(); break;
    case 3: s->w[below(WC_MAX_INPUTS)] = any(); break;
    case 4: s->x[below(WC_MAX_STATES)] = any(); break;
    case 5: s->held[below(WC_MAX_CROSSINGS)] = any(); break;
    case 6: (below(2) ? s->slope : s->last_slope)[below(WC_MAX_INPUTS)] = any(); break;
    case 7: *times[below(6)] = any(); break;
    case 8: *words[below(6)] = whole(); break;
    default: ((unsigned char *)&s->tolerance)[below(sizeof *s - offsetof(wc_saved, tolerance))] ^= (unsigned char)draw();
    }
}

/* What is in `bytes`, with something else in it and the checksum to go with that. */
static void forge(void) {
    wc_saved s;
    memcpy(&s, bytes, sizeof s);
    for (unsigned i = below(3) + 1; i; i--) forge_once(&s);
    const unsigned char *byte = (const unsigned char *)&s.tolerance, *end = (const unsigned char *)(&s + 1);
    s.checksum = 14695981039346656037u;
    while (byte < end) s.checksum = (s.checksum ^ *byte++) * 1099511628211u;
    memcpy(bytes, &s, sizeof s);
}

static void count_forgery(int status) {
    check(status);
    if (status == 0) forgeries_taken++;
    else forgeries_refused++;
}

static void take_forged2(fmi2Component c) {
    if (fmi2GetFMUstate(c, &kept2) != fmi2OK || fmi2SerializeFMUstate(c, kept2, (char *)bytes, sizeof bytes) != fmi2OK) return;
    forge();
    fmi2Status status = fmi2DeSerializeFMUstate(c, (char *)bytes, sizeof(wc_saved), &kept2);
    count_forgery(status == fmi2OK ? fmi2SetFMUstate(c, kept2) : status);
}

static void take_forged3(fmi3Instance c) {
    if (fmi3GetFMUState(c, &kept3) != fmi3OK || fmi3SerializeFMUState(c, kept3, bytes, sizeof bytes) != fmi3OK) return;
    forge();
    fmi3Status status = fmi3DeserializeFMUState(c, bytes, sizeof(wc_saved), &kept3);
    count_forgery(status == fmi3OK ? fmi3SetFMUState(c, kept3) : status);
}

/* ---- one random call ---- */

static void call2(fmi2Component c) {
    size_t n = fill(), m = below(MOST + 1);
    fmi2Boolean a, b;
    fmi2EventInfo info;
    switch (below(36)) {
    case 0: check(fmi2SetupExperiment(c, (int)below(2), number(), below(3) ? 0 : number(), (int)below(2), number())); break;
    case 1: case 2: check(fmi2EnterInitializationMode(c)); break;
    case 3: case 4: check(fmi2ExitInitializationMode(c)); break;
    case 5: check(below(8) ? fmi2OK : fmi2Terminate(c)); break;
    case 6: check(below(8) ? fmi2OK : fmi2Reset(c)); break;
    case 7: case 8: check(fmi2GetReal(c, vr, n, values)); break;
    case 9: case 10: case 11: check(fmi2SetReal(c, vr, below(9) ? 1 : n, values)); break;
    case 12: check(fmi2GetInteger(c, vr, n, ints)); break;
    case 13: check(fmi2SetInteger(c, vr, 1, ints)); break;
    case 14: check(fmi2GetBoolean(c, vr, n, ints)); break;
    case 15: check(fmi2SetBoolean(c, vr, n, ints)); break;
    case 16: check(fmi2GetString(c, vr, n, 0)); break;
    case 17: check(fmi2GetFMUstate(c, below(9) ? &kept2 : 0)); break;
    case 18: check(fmi2SetFMUstate(c, kept2)); break;
    case 19: check(fmi2SerializeFMUstate(c, kept2, (char *)bytes, below(4) ? sizeof bytes : below(9000))); break;
    case 20:
        if (kept2) fmi2SerializedFMUstateSize(c, kept2, &saved2);
        if (below(2)) bytes[below(sizeof bytes)] ^= (unsigned char)draw();
        check(fmi2DeSerializeFMUstate(c, (char *)bytes, below(4) ? saved2 : below(sizeof bytes), &kept2));
        break;
    case 21: check(fmi2FreeFMUstate(c, &kept2)); break;
    case 22: check(fmi2GetDirectionalDerivative(c, vr, n, more, m, values, results)); break;
    case 23: check(fmi2SetRealInputDerivatives(c, vr, n, order, values)); break;
    case 24: check(fmi2GetRealOutputDerivatives(c, vr, n, order, results)); break;
    case 25: case 26: case 27: check(fmi2DoStep(c, below(9) ? clock_of2(c) : number(), below(3) ? 0.003 : fmod(number(), 0.2), 1)); break;
    case 28: check(fmi2NewDiscreteStates(c, below(9) ? &info : 0)); check(fmi2EnterContinuousTimeMode(c)); break;
    case 29: check(fmi2SetTime(c, number())); check(fmi2EnterEventMode(c)); break;
    case 30:
        check(fmi2GetContinuousStates(c, results, below(9) ? states : n));
        if (below(2)) results[below(states)] = number();
        check(fmi2SetContinuousStates(c, results, below(9) ? states : n));
        break;
    case 31: check(fmi2GetDerivatives(c, results, below(9) ? states : n)); check(fmi2GetEventIndicators(c, results, n)); break;
    case 32: check(fmi2CompletedIntegratorStep(c, 1, &a, below(9) ? &b : 0)); break;
    case 33: case 34: take_forged2(c); break;
    default: check(fmi2GetReal(c, below(2) ? 0 : vr, n, below(2) ? 0 : values)); check(fmi2SetDebugLogging(c, 1, n, 0)); break;
    }
}

static void call3(fmi3Instance c) {
    size_t n = fill(), m = below(9) ? n : below(MOST + 1), k = below(MOST + 1);
    bool a, b, d, e, g;
    double t = 0;
    unsigned time = 0;
    inside = c;
    switch (below(32)) {
    case 0: case 1: check(fmi3EnterInitializationMode(c, below(2), number(), below(3) ? 0 : number(), below(2), number())); break;
    case 2: case 3: check(fmi3ExitInitializationMode(c)); break;
    case 4: check(below(8) ? fmi3OK : fmi3Terminate(c)); break;
    case 5: check(below(8) ? fmi3OK : fmi3Reset(c)); break;
    case 6: case 7: check(fmi3GetFloat64(c, vr, n, values, m)); break;
    case 8: case 9: case 10: check(fmi3SetFloat64(c, vr, 1, values, below(9) ? 1 : m)); break;
    case 11: check(fmi3GetInt64(c, vr, n, wide, m)); break;
    case 12: check(fmi3SetInt64(c, vr, 1, wide, 1)); break;
    case 13: check(fmi3GetBoolean(c, vr, n, truth, m)); break;
    case 14: check(fmi3SetBoolean(c, vr, n, truth, m)); break;
    case 15: check(fmi3GetFMUState(c, &kept3)); break;
    case 16: check(fmi3SetFMUState(c, kept3)); break;
    case 17: check(fmi3SerializeFMUState(c, kept3, bytes, below(4) ? sizeof bytes : below(9000))); break;
    case 18:
        if (kept3) fmi3SerializedFMUStateSize(c, kept3, &saved3);
        check(fmi3DeserializeFMUState(c, bytes, below(4) ? saved3 : below(sizeof bytes), &kept3));
        break;
    case 19: check(fmi3FreeFMUState(c, &kept3)); break;
    case 20: check(fmi3GetDirectionalDerivative(c, vr, n, more, k, values, below(9) ? k : m, results, n)); break;
    case 21: check(fmi3GetAdjointDerivative(c, vr, n, more, k, values, n, results, below(9) ? k : m)); break;
    case 22: check(fmi3GetOutputDerivatives(c, vr, n, order, results, m)); break;
    case 23: case 24: case 25:
        fmi3GetFloat64(c, &time, 1, &t, 1);
        check(fmi3DoStep(c, below(9) ? t : number(), below(3) ? 0.003 : fmod(number(), 0.2), true, &a, &b, &d, below(9) ? &t : 0));
        break;
    case 26: check(fmi3UpdateDiscreteStates(c, &a, &b, &d, &e, &g, &t)); check(fmi3EnterContinuousTimeMode(c)); break;
    case 27:
        check(fmi3GetContinuousStates(c, results, below(9) ? states : n));
        if (below(2)) results[below(states)] = number();
        check(fmi3SetContinuousStates(c, results, below(9) ? states : n));
        check(fmi3GetContinuousStateDerivatives(c, results, below(9) ? states : n));
        break;
    case 29: case 30: take_forged3(c); break;
    case 28: check(fmi3SetTime(c, number())); check(fmi3EnterEventMode(c)); check(fmi3CompletedIntegratorStep(c, true, &a, &b)); break;
    default: check(fmi3GetClock(c, vr, n, truth)); check(fmi3EnterConfigurationMode(c)); check(fmi3EnterStepMode(c)); break;
    }
}

/* The end of a short run of a fresh or reset instance. */
static double run2(fmi2Component c) {
    unsigned u = 0;
    double t = 0;
    fmi2EnterInitializationMode(c);
    fmi2ExitInitializationMode(c);
    for (int i = 0; i < 3; i++) fmi2DoStep(c, i * 0.01, 0.01, 1);
    double sum = 0;
    for (u = 0; u < variables; u++) sum += fmi2GetReal(c, &u, 1, &t) == fmi2OK ? t * (u + 1) : 0;
    return sum;
}

/* The lives' own seeds, or libFuzzer's input. */
static const uint8_t *food;
static size_t left;

static int feed(void) {
    if (!food) return 1;
    if (left < sizeof random_state) return 0;
    memcpy(&random_state, food, sizeof random_state);
    if (!random_state) random_state = 1; /* from which xorshift would not move */
    food += sizeof random_state;
    left -= sizeof random_state;
    return 1;
}

static void live(uint64_t seed) {
    random_state = seed * 0x9E3779B97F4A7C15u + 1;
    memset(bytes, 0, sizeof bytes);
    saved2 = saved3 = 0;
    fmi2CallbackFunctions callbacks = {heard2, calloc, free, 0, 0};
    fmi2Component c2[2];
    fmi3Instance c3[2];
    c2[0] = fmi2Instantiate("cs", fmi2CoSimulation, token, 0, &callbacks, 0, (int)below(2));
    c2[1] = fmi2Instantiate("me", fmi2ModelExchange, token, 0, &callbacks, 0, 1);
    c3[0] = fmi3InstantiateCoSimulation("cs", token, 0, false, true, false, below(2), 0, 0, 0, heard3, below(2) ? update : 0);
    c3[1] = fmi3InstantiateModelExchange("me", token, 0, false, true, 0, heard3);
    if (!c2[0] || !c2[1] || !c3[0] || !c3[1]) abort();
    double fresh = run2(c2[0]);
    for (int i = 0; i < CALLS && feed(); i++) {
        if (below(2)) {
            call2(c2[below(2)]);
        } else {
            call3(c3[below(2)]);
        }
    }
    fmi2Reset(c2[0]);
    if (run2(c2[0]) != fresh) {
        fprintf(stderr, "seed %llu: a reset instance steps otherwise than a new one\n", (unsigned long long)seed);
        abort();
    }
    fmi2FreeFMUstate(c2[0], &kept2);
    fmi3FreeFMUState(c3[0], &kept3);
    for (int i = 0; i < 2; i++) {
        fmi2FreeInstance(c2[i]);
        fmi3FreeInstance(c3[i]);
    }
}

#ifdef LIBFUZZER

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    token = getenv("TOKEN");
    variables = (unsigned)atoi(getenv("VARIABLES"));
    states = (unsigned)atoi(getenv("STATES"));
    food = data;
    left = size;
    live(1);
    if (bad_status) abort();
    return 0;
}

#else

int main(int n, char **word) {
    if (n != 6) return 2;
    token = word[1];
    variables = (unsigned)atoi(word[2]);
    states = (unsigned)atoi(word[3]);
    uint64_t first = strtoull(word[4], 0, 10), seeds = strtoull(word[5], 0, 10);
    for (uint64_t seed = first; seed < first + seeds; seed++) {
        fprintf(stderr, "\rseed %llu", (unsigned long long)seed);
        live(seed);
    }
    fprintf(stderr, "\n");
    printf("%llu sentences %llu taken %llu refused\n", (unsigned long long)sentences, (unsigned long long)forgeries_taken,
           (unsigned long long)forgeries_refused);
    return bad_status ? 1 : 0;
}

#endif
