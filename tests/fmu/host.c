/* A host without Python: loads an FMU's library and drives it.
 *
 *     host LIBRARY GUID MODE STEPS LENGTH IN_LEFT IN_RIGHT OUT...
 *
 * The last arguments are value references. MODE: final prints the outputs after the last step; time
 * prints median and worst cost of set + doStep + get in nanoseconds, the worst over steps of the
 * smallest of five repeats; memory prints by how many KiB the process has grown and how often anything in it has asked for
 * memory in all steps but the first thousand; freed prints what doStep and get say of an instance that has been freed, and how
 * often it was given back when freed twice; reset prints how many of STEPS runs after
 * fmi2Reset differ in any byte from the first; cycles makes and frees STEPS instances, each with a run, and prints the same
 * and by how many KiB the process has grown since the first tenth of them; minute measures as time does, over a ride with
 * turns, stops and reversals, and also prints the cost at rest in its last eighth over that in motion in its first; ride drives
 * that ride in real time, each step at its due moment, and prints median, 99.9th percentile and worst cost, how late the worst
 * step was woken, and how many steps were not done when the next was due; underflow prints how many steps of that ride meet a
 * result too small for a normal number.
 */
#define _GNU_SOURCE
#include <dlfcn.h>
#include <fenv.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

#include "fmi2FunctionTypes.h"

#define REPEATS 5
#define MOST 16

static fmi2InstantiateTYPE *instantiate;
static fmi2SetupExperimentTYPE *setup;
static fmi2EnterInitializationModeTYPE *enter;
static fmi2ExitInitializationModeTYPE *leave;
static fmi2SetRealTYPE *set;
static fmi2GetRealTYPE *get;
static fmi2DoStepTYPE *do_step;
static fmi2ResetTYPE *reset;
static fmi2TerminateTYPE *terminate;
static fmi2FreeInstanceTYPE *release;

static long allocations, given_back;
static void *kept; /* memory that is not given back, though it has been freed */
static fmi2ValueReference in[2], out[MOST];
static size_t outs;

/* In place of the C library's functions, for the FMU too. */
extern void *__libc_malloc(size_t), *__libc_calloc(size_t, size_t), *__libc_realloc(void *, size_t);
extern void __libc_free(void *);

void *malloc(size_t size) {
    allocations++;
    return __libc_malloc(size);
}

void *calloc(size_t n, size_t size) {
    allocations++;
    return __libc_calloc(n, size);
}

void *realloc(void *old, size_t size) {
    allocations++;
    return __libc_realloc(old, size);
}

void free(void *memory) {
    if (memory && memory == kept) {
        given_back++;
    } else {
        __libc_free(memory);
    }
}

/* The FMU says that it cannot use them. */
static void *broken_allocate(size_t n, size_t size) {
    fprintf(stderr, "the FMU asks the host for %zu times %zu bytes\n", n, size);
    exit(1);
}

static void broken_free(void *memory) {
    fprintf(stderr, "the FMU gives the host back %p\n", memory);
    exit(1);
}

static void logger(fmi2ComponentEnvironment e, fmi2String name, fmi2Status status, fmi2String category, fmi2String text,
                   ...) {
    (void)e;
    va_list rest;
    va_start(rest, text);
    fprintf(stderr, "%s %d %s: ", name, (int)status, category);
    vfprintf(stderr, text, rest);
    fputc('\n', stderr);
    va_end(rest);
}

static void check(fmi2Status status, const char *what) {
    if (status == fmi2OK) return;
    fprintf(stderr, "%s gives status %d\n", what, (int)status);
    exit(1);
}

static void *need(void *library, const char *name) {
    void *symbol = dlsym(library, name);
    if (!symbol) {
        fprintf(stderr, "no %s\n", name);
        exit(1);
    }
    return symbol;
}

static void begin(fmi2Component c) {
    check(setup(c, fmi2False, 0, 0, fmi2False, 0), "fmi2SetupExperiment");
    check(enter(c), "fmi2EnterInitializationMode");
    check(leave(c), "fmi2ExitInitializationMode");
}

/* Pushes once a second on both sides, a little more on the left. */
static void push(long i, double h, fmi2Real w[2]) {
    double beat = sin(2 * 3.141592653589793 * (double)i * h), both = beat > 0 ? 60 * beat : 0;
    w[0] = both + 1;
    w[1] = both - 1;
}

static void step_with(fmi2Component c, long i, double h, const fmi2Real w[2], fmi2Real *y) {
    check(set(c, in, 2, w), "fmi2SetReal");
    check(do_step(c, (double)i * h, h, fmi2True), "fmi2DoStep");
    check(get(c, out, outs, y), "fmi2GetReal");
}

static void step(fmi2Component c, long i, double h, fmi2Real *y) {
    fmi2Real w[2];
    push(i, h, w);
    step_with(c, i, h, w, y);
}

static double now(void) {
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec * 1e9 + (double)t.tv_nsec;
}

static long resident(void) {
    long size = 0, pages = 0;
    FILE *f = fopen("/proc/self/statm", "r");
    if (f && fscanf(f, "%ld %ld", &size, &pages) != 2) pages = 0;
    if (f) fclose(f);
    return pages * (sysconf(_SC_PAGESIZE) / 1024);
}

static int ascending(const void *a, const void *b) {
    double x = *(const double *)a, y = *(const double *)b;
    return x < y ? -1 : x > y;
}

/* A minute of strokes, turns on the spot, coasting to rest, strokes backwards, and rest: pushes at time t. */
static void ride_push(double t, double whole, fmi2Real w[2]) {
    double part = t / whole * 8, beat = sin(2 * 3.141592653589793 * t), stroke = beat > 0 ? 60 * beat : 0;
    double left = part < 2 ? 1 : part < 3 ? 1 : part < 4 ? -1 : part < 5 ? 0 : part < 7 ? -1 : 0;
    double right = part < 2 ? 1 : part < 3 ? -1 : part < 4 ? 1 : part < 5 ? 0 : part < 7 ? -0.9 : 0;
    w[0] = left * stroke;
    w[1] = right * stroke;
}

static void measure(fmi2Component c, long steps, double h, int riding) {
    double y[MOST], *least = malloc(sizeof(double) * (size_t)steps), moving = 0, resting = 0;
    for (int r = 0; r < REPEATS; r++) {
        check(reset(c), "fmi2Reset");
        begin(c);
        for (long i = 0; i < steps; i++) {
            fmi2Real w[2];
            if (riding) {
                ride_push((double)i * h, (double)steps * h, w);
            } else {
                push(i, h, w);
            }
            double before = now();
            step_with(c, i, h, w, y);
            double cost = now() - before;
            if (!r || cost < least[i]) least[i] = cost;
        }
    }
    for (long i = 0; i < steps / 8; i++) {
        moving += least[i];
        resting += least[steps - 1 - i];
    }
    qsort(least, (size_t)steps, sizeof *least, ascending);
    printf("%.0f %.0f", least[steps / 2], least[steps - 1]);
    printf(riding ? " %.3f\n" : "\n", resting / moving);
    free(least);
}

static void ride(fmi2Component c, long steps, double h) {
    double *cost = malloc(sizeof(double) * (size_t)steps), y[MOST], late = 0;
    long missed = 0;
    struct timespec due;
    clock_gettime(CLOCK_MONOTONIC, &due);
    for (long i = 0; i < steps; i++) {
        fmi2Real w[2];
        ride_push((double)i * h, (double)steps * h, w);
        due.tv_nsec += (long)(h * 1e9);
        while (due.tv_nsec >= 1000000000) {
            due.tv_nsec -= 1000000000;
            due.tv_sec++;
        }
        double at = (double)due.tv_sec * 1e9 + (double)due.tv_nsec;
        if (now() > at) missed++;
        clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &due, 0);
        double before = now();
        if (before - at > late) late = before - at;
        step_with(c, i, h, w, y);
        cost[i] = now() - before;
    }
    qsort(cost, (size_t)steps, sizeof *cost, ascending);
    printf("%.0f %.0f %.0f %.0f %ld\n", cost[steps / 2], cost[(long)((double)steps * 0.999)], cost[steps - 1], late, missed);
    free(cost);
}

static long count_underflows(fmi2Component c, long steps, double h) {
    double y[MOST];
    long count = 0;
    for (long i = 0; i < steps; i++) {
        fmi2Real w[2];
        ride_push((double)i * h, (double)steps * h, w);
        feclearexcept(FE_UNDERFLOW);
        step_with(c, i, h, w, y);
        count += fetestexcept(FE_UNDERFLOW) != 0;
    }
    return count;
}

static long count_different(fmi2Component c, long runs, double h) {
    double first[MOST], y[MOST];
    long different = 0;
    for (long r = 0; r < runs; r++) {
        check(reset(c), "fmi2Reset");
        begin(c);
        for (long i = 0; i < 20; i++) step(c, i, h, y);
        if (!r) memcpy(first, y, sizeof first);
        different += memcmp(first, y, sizeof(double) * outs) != 0;
    }
    return different;
}

static long count_cycles(const char *guid, const fmi2CallbackFunctions *callbacks, long cycles, double h) {
    double first[MOST], y[MOST];
    long different = 0, before = 0;
    for (long r = 0; r < cycles; r++) {
        fmi2Component c = instantiate("one of many", fmi2CoSimulation, guid, "", callbacks, fmi2False, fmi2False);
        if (!c) return -1;
        begin(c);
        for (long i = 0; i < 5; i++) step(c, i, h, y);
        if (!r) memcpy(first, y, sizeof first);
        different += memcmp(first, y, sizeof(double) * outs) != 0;
        release(c);
        if (r == cycles / 10) before = resident();
    }
    printf("%ld %ld\n", different, resident() - before);
    return 0;
}

static void print_after_free(const char *guid, const fmi2CallbackFunctions *callbacks) {
    double y[MOST];
    fmi2Component c = kept = instantiate("freed", fmi2CoSimulation, guid, "", callbacks, fmi2False, fmi2False);
    begin(c);
    step(c, 0, 0.01, y);
    release(c);
    printf("%d %d ", (int)do_step(c, 0.01, 0.01, fmi2True), (int)get(c, out, outs, y));
    release(c);
    printf("%ld\n", given_back);
    kept = 0;
}

int main(int n, char **word) {
    if (n < 9 || n - 8 > MOST) return 2;
    void *library = dlopen(word[1], RTLD_NOW | RTLD_LOCAL);
    if (!library) {
        fprintf(stderr, "%s\n", dlerror());
        return 1;
    }
    instantiate = (fmi2InstantiateTYPE *)need(library, "fmi2Instantiate");
    setup = (fmi2SetupExperimentTYPE *)need(library, "fmi2SetupExperiment");
    enter = (fmi2EnterInitializationModeTYPE *)need(library, "fmi2EnterInitializationMode");
    leave = (fmi2ExitInitializationModeTYPE *)need(library, "fmi2ExitInitializationMode");
    set = (fmi2SetRealTYPE *)need(library, "fmi2SetReal");
    get = (fmi2GetRealTYPE *)need(library, "fmi2GetReal");
    do_step = (fmi2DoStepTYPE *)need(library, "fmi2DoStep");
    reset = (fmi2ResetTYPE *)need(library, "fmi2Reset");
    terminate = (fmi2TerminateTYPE *)need(library, "fmi2Terminate");
    release = (fmi2FreeInstanceTYPE *)need(library, "fmi2FreeInstance");
    long steps = atol(word[4]);
    double h = atof(word[5]), y[MOST];
    for (int i = 0; i < 2; i++) in[i] = (fmi2ValueReference)atoi(word[6 + i]);
    for (outs = 0; (int)outs < n - 8; outs++) out[outs] = (fmi2ValueReference)atoi(word[8 + outs]);

    fmi2CallbackFunctions callbacks = {logger, broken_allocate, broken_free, 0, 0};
    fmi2Component c = instantiate("chair", fmi2CoSimulation, word[2], "", &callbacks, fmi2False, fmi2False);
    if (!c) return 1;
    begin(c);
    if (!strcmp(word[3], "final")) {
        for (long i = 0; i < steps; i++) step(c, i, h, y);
        for (size_t i = 0; i < outs; i++) printf("%.17g\n", y[i]);
    } else if (!strcmp(word[3], "time")) {
        measure(c, steps, h, 0);
    } else if (!strcmp(word[3], "memory")) {
        for (long i = 0; i < 1000; i++) step(c, i, h, y);
        long before = resident(), asked = allocations;
        for (long i = 1000; i < steps; i++) step(c, i, h, y);
        asked = allocations - asked;
        printf("%ld %ld\n", resident() - before, asked);
    } else if (!strcmp(word[3], "freed")) {
        print_after_free(word[2], &callbacks);
    } else if (!strcmp(word[3], "reset")) {
        printf("%ld\n", count_different(c, steps, h));
    } else if (!strcmp(word[3], "minute")) {
        measure(c, steps, h, 1);
    } else if (!strcmp(word[3], "ride")) {
        ride(c, steps, h);
    } else if (!strcmp(word[3], "underflow")) {
        printf("%ld\n", count_underflows(c, steps, h));
    } else if (!strcmp(word[3], "cycles")) {
        if (count_cycles(word[2], &callbacks, steps, h)) return 1;
    } else {
        return 2;
    }
    check(terminate(c), "fmi2Terminate");
    release(c);
    release(0);
    dlclose(library);
    return 0;
}
