/* What a core can do: twelve numbers, or vectors of them, that wait for nothing but their own last value. */
#include "lanes.h"

#ifdef ALONE
typedef double number;
#define ROOT sqrt
#else
typedef lanes number;
#define ROOT lanes_sqrt
#endif

#define EACH(DO) DO(a) DO(b) DO(c) DO(d) DO(e) DO(f) DO(g) DO(h) DO(i) DO(j) DO(k) DO(l)
#define BEGIN(x) number x = {0}; x += *begin++;
#define SUM(x) x = x * 0.5 + 0.25;
#define QUOTIENT(x) x = 1.0 / x;
#define ROOTED(x) x = ROOT(x);
#define END(x) all += x;

#define LOOP(NAME, DO)                                       \
    void NAME(long n, const double *begin, double *found) {  \
        EACH(BEGIN)                                          \
        for (long count = 0; count < n; count++) { EACH(DO) } \
        number all = {0};                                    \
        EACH(END)                                            \
        *(number *)found = all;                              \
    }

LOOP(sums, SUM)
LOOP(quotients, QUOTIENT)
LOOP(roots, ROOTED)
