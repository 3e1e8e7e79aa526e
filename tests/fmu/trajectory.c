/* The smallest host: one chair, pushed in strokes that turn it right and left, through either version of FMI.
 *
 *     trajectory LIBRARY TOKEN VERSION STEPS LENGTH IN_LEFT IN_RIGHT OUT...
 *
 * VERSION is 2 or 3, the last arguments are value references; prints the outputs after every step.
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "fmi2FunctionTypes.h"
#include "fmi3FunctionTypes.h"
#include "loading.h"

#define MOST 32

static void *library;
static unsigned in[2], out[MOST];
static size_t outs;

static void check(int status, const char *what) {
    if (!status) return;
    fprintf(stderr, "%s gives status %d\n", what, status);
    exit(1);
}

/* Strokes once a second, first harder on the left, then on the right. No sine: its last digit is the library's. */
static void push(long i, double h, double w[2]) {
    double phase = fmod((double)i * h, 1), more = fmod((double)i * h, 2) < 1 ? 4 : -6;
    double both = phase < 0.5 ? 640 * phase * (0.5 - phase) : 0;
    w[0] = both + more;
    w[1] = both - more;
}

static void print(const double *y) {
    for (size_t k = 0; k < outs; k++) printf("%.17g%c", y[k], k + 1 < outs ? ' ' : '\n');
}

static void by_fmi2(const char *token, long steps, double h) {
    fmi2CallbackFunctions callbacks = {0, calloc, free, 0, 0};
    fmi2Component c = ((fmi2InstantiateTYPE *)need(library, "fmi2Instantiate"))("chair", fmi2CoSimulation, token, "", &callbacks,
                                                                                fmi2False, fmi2False);
    if (!c) check(3, "fmi2Instantiate");
    check(((fmi2SetupExperimentTYPE *)need(library, "fmi2SetupExperiment"))(c, 0, 0, 0, 0, 0), "fmi2SetupExperiment");
    check(((fmi2EnterInitializationModeTYPE *)need(library, "fmi2EnterInitializationMode"))(c), "enter");
    check(((fmi2ExitInitializationModeTYPE *)need(library, "fmi2ExitInitializationMode"))(c), "exit");
    fmi2SetRealTYPE *set = (fmi2SetRealTYPE *)need(library, "fmi2SetReal");
    fmi2GetRealTYPE *get = (fmi2GetRealTYPE *)need(library, "fmi2GetReal");
    fmi2DoStepTYPE *go = (fmi2DoStepTYPE *)need(library, "fmi2DoStep");
    double w[2], y[MOST];
    for (long i = 0; i < steps; i++) {
        push(i, h, w);
        check(set(c, in, 2, w), "fmi2SetReal");
        check(go(c, (double)i * h, h, 1), "fmi2DoStep");
        check(get(c, out, outs, y), "fmi2GetReal");
        print(y);
    }
    check(((fmi2TerminateTYPE *)need(library, "fmi2Terminate"))(c), "fmi2Terminate");
    ((fmi2FreeInstanceTYPE *)need(library, "fmi2FreeInstance"))(c);
}

static void by_fmi3(const char *token, long steps, double h) {
    fmi3Instance c = ((fmi3InstantiateCoSimulationTYPE *)need(library, "fmi3InstantiateCoSimulation"))(
        "chair", token, "", false, false, false, false, 0, 0, 0, 0, 0);
    if (!c) check(3, "fmi3InstantiateCoSimulation");
    check(((fmi3EnterInitializationModeTYPE *)need(library, "fmi3EnterInitializationMode"))(c, false, 0, 0, false, 0), "enter");
    check(((fmi3ExitInitializationModeTYPE *)need(library, "fmi3ExitInitializationMode"))(c), "exit");
    fmi3SetFloat64TYPE *set = (fmi3SetFloat64TYPE *)need(library, "fmi3SetFloat64");
    fmi3GetFloat64TYPE *get = (fmi3GetFloat64TYPE *)need(library, "fmi3GetFloat64");
    fmi3DoStepTYPE *go = (fmi3DoStepTYPE *)need(library, "fmi3DoStep");
    double w[2], y[MOST], reached;
    bool event, end, early;
    for (long i = 0; i < steps; i++) {
        push(i, h, w);
        check(set(c, in, 2, w, 2), "fmi3SetFloat64");
        check(go(c, (double)i * h, h, true, &event, &end, &early, &reached), "fmi3DoStep");
        check(get(c, out, outs, y, outs), "fmi3GetFloat64");
        print(y);
    }
    check(((fmi3TerminateTYPE *)need(library, "fmi3Terminate"))(c), "fmi3Terminate");
    ((fmi3FreeInstanceTYPE *)need(library, "fmi3FreeInstance"))(c);
}

int main(int n, char **word) {
    if (n < 9 || n - 8 > MOST) return 2;
    library = load(word[1]);
    for (int i = 0; i < 2; i++) in[i] = (unsigned)atoi(word[6 + i]);
    for (outs = 0; (int)outs < n - 8; outs++) out[outs] = (unsigned)atoi(word[8 + outs]);
    (strcmp(word[3], "3") ? by_fmi2 : by_fmi3)(word[2], atol(word[4]), atof(word[5]));
    return 0;
}
