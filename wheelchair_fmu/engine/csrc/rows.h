/* Sums of short rows of numbers, of whole lanes each. Where a row's length is known when this is compiled, its sum stays in
 * registers: a row in memory that is added to again and again makes each sum wait for the last. */
#ifndef WC_ROWS_H
#define WC_ROWS_H

#define LANE 4  /* numbers that stand side by side */
#define LANES 6 /* so many of which stay in registers together, at most */

typedef double lane __attribute__((vector_size(8 * LANE), aligned(8), may_alias));

/* n rows one after the other, every `between` numbers, and a factor of each, every `apart` numbers. */
typedef struct {
    int n;
    const double *first;
    long between;
    const double *factors;
    long apart;
} weighed_rows;

/* Numbers of a row that is as long as so many at least. */
static inline int padded(int n) { return (n + LANE - 1) / LANE * LANE; }

static inline __attribute__((always_inline)) lane lane_of(const double *row, int l) { return ((const lane *)row)[l]; }

/* Of rows that are `lanes` long, some at a time. */
static inline __attribute__((always_inline)) void add_lanes(int lanes, int some, double sign, const weighed_rows *of, double *to) {
    const double *first = of->first, *factors = of->factors;
    long between = of->between, apart = of->apart;
    for (int from = 0; from < lanes; from += some) {
        lane sum[LANES];
        for (int l = 0; l < some; l++) sum[l] = lane_of(to, from + l);
        for (int i = 0; i < of->n; i++) {
            double factor = sign * factors[i * apart];
            for (int l = 0; l < some; l++) sum[l] += factor * lane_of(first + i * between, from + l);
        }
        for (int l = 0; l < some; l++) ((lane *)to)[from + l] = sum[l];
    }
}

/* to += sign * Σ factor * row; `stride` numbers long. */
static void add_rows(int stride, double sign, const weighed_rows *of, double *to) {
    switch (stride / LANE) {
#ifndef __wasm__ /* where what is small wins */
    case 1: add_lanes(1, 1, sign, of, to); break;
    case 2: add_lanes(2, 2, sign, of, to); break;
    case 3: add_lanes(3, 3, sign, of, to); break;
    case 4: add_lanes(4, 4, sign, of, to); break;
    case 5: add_lanes(5, 5, sign, of, to); break;
    case 6: add_lanes(6, 6, sign, of, to); break;
#endif
    default: add_lanes(stride / LANE, 1, sign, of, to);
    }
}

/* to += factor * row. */
static inline void add_row_of(int stride, double factor, const double *row, double *to) {
    for (int l = 0; l < stride / LANE; l++) ((lane *)to)[l] += factor * lane_of(row, l);
}

#endif
