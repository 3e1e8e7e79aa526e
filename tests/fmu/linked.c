/* Two source FMUs in one program, by the prefixes of their functions:
 *
 *     linked STEPS FIRST_TOKEN FIRST_INPUT FIRST_OUTPUT SECOND_TOKEN SECOND_INPUT SECOND_OUTPUT
 *
 * Both are stepped in turn; the second is pushed three times as hard. Prints the output of each at the end.
 */
#include <stdio.h>
#include <stdlib.h>

#include "fmi3FunctionTypes.h"

#define DECLARED(prefix)                                                                                           \
    extern fmi3InstantiateCoSimulationTYPE prefix##fmi3InstantiateCoSimulation;                                    \
    extern fmi3EnterInitializationModeTYPE prefix##fmi3EnterInitializationMode;                                    \
    extern fmi3ExitInitializationModeTYPE prefix##fmi3ExitInitializationMode;                                      \
    extern fmi3SetFloat64TYPE prefix##fmi3SetFloat64;                                                              \
    extern fmi3GetFloat64TYPE prefix##fmi3GetFloat64;                                                              \
    extern fmi3DoStepTYPE prefix##fmi3DoStep;                                                                      \
    extern fmi3FreeInstanceTYPE prefix##fmi3FreeInstance;
DECLARED(First_)
DECLARED(Second_)

static void check(fmi3Status status) {
    if (status == fmi3OK) return;
    fprintf(stderr, "status %d\n", (int)status);
    exit(1);
}

#define START(prefix, token, input, push)                                                                          \
    prefix##fmi3InstantiateCoSimulation("chair", token, 0, false, false, false, false, 0, 0, 0, 0, 0);             \
    check(prefix##fmi3SetFloat64(prefix##c, input, 1, &push, 1));                                                  \
    check(prefix##fmi3EnterInitializationMode(prefix##c, false, 0, 0, false, 0));                                  \
    check(prefix##fmi3ExitInitializationMode(prefix##c))
#define STEP(prefix, i) check(prefix##fmi3DoStep(prefix##c, i * 0.01, 0.01, true, &event, &terminate, &early, &last))

int main(int n, char **word) {
    if (n != 8) return 2;
    fmi3ValueReference vr[8];
    bool event, terminate, early;
    double gentle = 10, hard = 30, end[2], last;
    for (int i = 1; i < 8; i++) vr[i] = (fmi3ValueReference)atoi(word[i]);
    fmi3Instance First_c = START(First_, word[2], &vr[3], gentle);
    fmi3Instance Second_c = START(Second_, word[5], &vr[6], hard);
    for (int i = 0; i < atoi(word[1]); i++) {
        STEP(First_, i);
        STEP(Second_, i);
    }
    check(First_fmi3GetFloat64(First_c, &vr[4], 1, &end[0], 1));
    check(Second_fmi3GetFloat64(Second_c, &vr[7], 1, &end[1], 1));
    printf("%a %a\n", end[0], end[1]);
    First_fmi3FreeInstance(First_c);
    Second_fmi3FreeInstance(Second_c);
    return 0;
}
