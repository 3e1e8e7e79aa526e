/* Numbers of several chairs side by side, one in each lane of a vector, and the functions of them that a model is made of.
 *
 * Every lane is what it would be alone: no result depends on what its neighbours are. Sums, products, quotients and roots are
 * rounded as those of single numbers. Without a branch, sines are within a unit in the last place, exponentials and logarithms
 * within 1.5, arctangents within 2.5; where an argument is too large for that, or infinite, its lane is the C library's.
 *
 * Coefficients: Taylor's for sin, cos and exp; for atan and log, of Chebyshev interpolation in the square of the argument. */
#ifndef WC_LANES_H
#define WC_LANES_H

#include <math.h>

#ifdef __AVX__
#include <immintrin.h>
#endif

/* WC_LANES is how many fit into a vector of the processor; -D says so, as its flags do. */
typedef double lanes __attribute__((vector_size(8 * WC_LANES)));
typedef long long masks __attribute__((vector_size(8 * WC_LANES))); /* all bits of a lane, or none */

#define WC_INLINE static inline __attribute__((always_inline))
#define WC_EVEN(value) ((lanes){0} + (value))                           /* the same in each lane */
#define WC_BITS(mask, a) ((lanes)((mask) & (masks)(a)))                 /* a, or zero */
#define WC_SIGN ((masks){0} - 0x7fffffffffffffffLL - 1)
#define WC_TRUE(mask) WC_BITS(mask, WC_EVEN(1.0))                       /* what C says of a comparison */
#define WC_ALL ((masks){0} - 1)
#define WC_ROUND 6755399441055744.0 /* 1.5 * 2^52: what is added to it is rounded to an integer, and stands in its last bits */

WC_INLINE lanes lanes_choose(masks mask, lanes a, lanes b) { return (lanes)((mask & (masks)a) | (~mask & (masks)b)); }

WC_INLINE int lanes_any(masks mask) {
#if defined(__AVX512F__) && WC_LANES == 8
    return _mm512_test_epi64_mask((__m512i)mask, (__m512i)mask) != 0;
#elif defined(__AVX__) && WC_LANES == 4
    return _mm256_movemask_pd((__m256d)mask) != 0;
#else
    long long any = 0;
    for (int e = 0; e < WC_LANES; e++) any |= mask[e];
    return any != 0;
#endif
}

WC_INLINE lanes lanes_sqrt(lanes a) {
#if defined(__AVX512F__) && WC_LANES == 8
    return (lanes)_mm512_sqrt_pd((__m512d)a);
#elif defined(__AVX__) && WC_LANES == 4
    return (lanes)_mm256_sqrt_pd((__m256d)a);
#else
    for (int e = 0; e < WC_LANES; e++) a[e] = sqrt(a[e]);
    return a;
#endif
}

WC_INLINE lanes lanes_fabs(lanes a) { return (lanes)((masks)a & ~WC_SIGN); }
WC_INLINE lanes lanes_copysign(lanes a, lanes b) { return (lanes)(((masks)a & ~WC_SIGN) | ((masks)b & WC_SIGN)); }
WC_INLINE lanes lanes_fmax(lanes a, lanes b) { return lanes_choose(a > b, a, b); }
WC_INLINE lanes lanes_fmin(lanes a, lanes b) { return lanes_choose(a < b, a, b); }
WC_INLINE lanes lanes_sign(lanes a) { return lanes_choose(a == 0, a, lanes_copysign(WC_EVEN(1.0), a)); }

/* The lanes of `mask` anew, by a function of single numbers. */
static __attribute__((noinline)) lanes lanes_anew(masks mask, lanes result, double (*f)(double), lanes a) {
    for (int e = 0; e < WC_LANES; e++)
        if (mask[e]) result[e] = f(a[e]);
    return result;
}

static __attribute__((noinline)) lanes lanes_anew2(masks mask, lanes result, double (*f)(double, double), lanes a, lanes b) {
    for (int e = 0; e < WC_LANES; e++)
        if (mask[e]) result[e] = f(a[e], b[e]);
    return result;
}

/* sin(a) for turns = 0, cos(a) for turns = 1. The argument less the nearest multiple of pi/2, whose first two parts are so short
 * that their products are exact. */
WC_INLINE lanes lanes_turned(lanes a, int turns) {
    lanes n = a * 0x1.45f306dc9c883p-1 + WC_ROUND;
    masks quarter = (masks)n + turns;
    n -= WC_ROUND;
    lanes t = a - n * 0x1.921fb544p+0, w = n * 0x1.0b4611a6p-34, first = t - w;
    w = n * 0x1.3198a2e037073p-69 - ((t - first) - w);
    lanes r = first - w, rest = (first - r) - w, z = r * r, half = 0.5 * z;
    lanes s = -1.0 / 6 + z * (1.0 / 120 + z * (-1.0 / 5040 + z * (1.0 / 362880 + z * (-1.0 / 39916800 + z * (1.0 / 6227020800
              + z * (-1.0 / 1307674368000 + z * (1.0 / 355687428096000)))))));
    lanes c = 1.0 / 24 + z * (-1.0 / 720 + z * (1.0 / 40320 + z * (-1.0 / 3628800 + z * (1.0 / 479001600
              + z * (-1.0 / 87178291200 + z * (1.0 / 20922789888000))))));
    lanes sine = r + (r * z * s + rest * (1 - half)), one = 1 - half;
    lanes cosine = one + (((1 - one) - half) + (z * z * c - r * rest));
    lanes of = lanes_choose((quarter & 1) == 0, sine, cosine);
    return (lanes)((masks)of ^ ((quarter << 62) & WC_SIGN));
}

WC_INLINE lanes lanes_sin(lanes a) {
    lanes result = lanes_turned(a, 0);
    masks far = ~(lanes_fabs(a) <= 8e5);
    result = lanes_choose(a == 0, a, result); /* with its sign */
    return lanes_any(far) ? lanes_anew(far, result, sin, a) : result;
}

WC_INLINE lanes lanes_cos(lanes a) {
    lanes result = lanes_turned(a, 1);
    masks far = ~(lanes_fabs(a) <= 8e5);
    return lanes_any(far) ? lanes_anew(far, result, cos, a) : result;
}

/* The angle in the half quadrant, by what it is more than 0 or less than pi/4; then so many eighths of a turn more or less. */
WC_INLINE lanes lanes_atan2(lanes y, lanes x) {
    lanes a = lanes_fabs(x), b = lanes_fabs(y);
    masks swapped = b > a, left = (masks)x < 0;
    lanes less = lanes_choose(swapped, a, b), more = lanes_choose(swapped, b, a);
    masks far = less > 0.41421356237309503 * more;
    lanes above = lanes_choose(far, less - more, less), below = lanes_choose(far, less + more, more);
    lanes q = above / lanes_choose(below == 0, WC_EVEN(1.0), below), z = q * q;
    lanes t = q + q * z * (-0.3333333333333333 + z * (0.19999999999995516 + z * (-0.14285714284665682 + z * (0.11111111015187018
              + z * (-0.0909090457530649 + z * (0.07692183125376892 + z * (-0.06664510525508936 + z * (0.05858140904866328
              + z * (-0.050854078345894844 + z * (0.03923044778479309 - z * 0.019175404711104935))))))))));
    lanes eighths = WC_TRUE(far);
    eighths = lanes_choose(swapped, 2 - eighths, eighths);
    eighths = lanes_choose(left, 4 - eighths, eighths);
    t = (lanes)((masks)t ^ ((swapped ^ left) & WC_SIGN));
    lanes result = lanes_copysign(eighths * 0x1.921fb54442d1p-1 + (eighths * 0x1.08d313198a2e0p-50 + t), y);
    masks wild = ~(a + b <= 1e308);
    return lanes_any(wild) ? lanes_anew2(wild, result, atan2, y, x) : result;
}

WC_INLINE lanes lanes_atan(lanes a) { return lanes_atan2(a, WC_EVEN(1.0)); }

WC_INLINE lanes lanes_exp(lanes a) {
    lanes n = a * 0x1.71547652b82fep+0 + WC_ROUND;
    masks power = (masks)n << 52;
    n -= WC_ROUND;
    lanes first = a - n * 0x1.62e42feep-1, w = n * 0x1.a39ef35793c76p-33, r = first - w, rest = (first - r) - w;
    lanes p = 1.0 / 2 + r * (1.0 / 6 + r * (1.0 / 24 + r * (1.0 / 120 + r * (1.0 / 720 + r * (1.0 / 5040 + r * (1.0 / 40320
              + r * (1.0 / 362880 + r * (1.0 / 3628800 + r * (1.0 / 39916800 + r * (1.0 / 479001600
              + r * (1.0 / 6227020800)))))))))));
    lanes result = (lanes)((masks)(1 + (r + (r * r * p + rest))) + power);
    masks wild = ~(lanes_fabs(a) <= 708);
    return lanes_any(wild) ? lanes_anew(wild, result, exp, a) : result;
}

/* a = 2^k m with m between the roots of 1/2 and of 2. */
WC_INLINE lanes lanes_log(lanes a) {
    masks power = ((masks)a - (masks)WC_EVEN(0.70710678118654752)) >> 52;
    lanes k = (lanes)((masks)WC_EVEN(WC_ROUND) + power) - WC_ROUND, f = (lanes)((masks)a - (power << 52)) - 1;
    lanes s = f / (2 + f), z = s * s, half = 0.5 * f * f;
    lanes r = z * (0.6666666666666666 + z * (0.40000000000000885 + z * (0.28571428570799784 + z * (0.22222222392581045
              + z * (0.18181795547521137 + z * (0.15386244737621665 + z * (0.13268638369266825 + z * 0.13088034850927555)))))));
    lanes result = k * 0x1.62e42feep-1 - ((half - (s * (half + r) + k * 0x1.a39ef35793c76p-33)) - f);
    masks wild = ~((a >= 0x1p-1022) & (a <= 1e308));
    return lanes_any(wild) ? lanes_anew(wild, result, log, a) : result;
}

#endif
