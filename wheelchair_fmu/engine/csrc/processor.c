/* How many numbers of eight bytes fit into a vector of this processor, as far as its system keeps them. */
#if defined(__x86_64__) && defined(__GNUC__)
#include <cpuid.h>

#define WC_KEPT 0x06       /* of register 0 of those that XGETBV reads: 32 bytes, */
#define WC_KEPT_WIDE 0xe6  /* and 64 bytes */

int wc_width(void) {
    unsigned a, b, c, d, kept, more;
    if (!__get_cpuid(1, &a, &b, &c, &d) || !(c & bit_OSXSAVE)) return 2;
    __asm__ volatile("xgetbv" : "=a"(kept), "=d"(more) : "c"(0));
    if (!__get_cpuid_count(7, 0, &a, &b, &c, &d)) return 2;
    unsigned wide = bit_AVX512F | bit_AVX512DQ | bit_AVX512VL;
    if ((kept & WC_KEPT_WIDE) == WC_KEPT_WIDE && (b & wide) == wide) return 8;
    return (kept & WC_KEPT) == WC_KEPT && (b & bit_AVX2) ? 4 : 2;
}
#else
int wc_width(void) { return 2; }
#endif
