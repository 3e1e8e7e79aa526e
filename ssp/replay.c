/* A recording in place of strokes. What comes before this in the same file: the generated unrecorded_* functions,
 * which give all but the pushes, the places CLOCK, F_RL and F_RR, the kernel's SIZES, and RECORDED samples record_t, record_F_rl, record_F_rr.
 */

/* The sample that begins the interval around t; −1 before the first and after the last. */
static int record_at(double t) {
    int low = 0, high = RECORDED - 1;
    if (!(t >= record_t[0]) || t > record_t[high]) return -1;
    while (high - low > 1) {
        int middle = (low + high) / 2;
        if (record_t[middle] <= t) low = middle;
        else high = middle;
    }
    return low;
}

static double record_slope(const double *force, int i) {
    return i < 0 ? 0 : (force[i + 1] - force[i]) / (record_t[i + 1] - record_t[i]);
}

static double record_value(const double *force, int i, double t) {
    return i < 0 ? 0 : force[i] + record_slope(force, i) * (t - record_t[i]);
}

static int recorded_output(const double **arg, double **res, long long *iw, double *w, int mem) {
    double t = arg[0][CLOCK];
    int i = record_at(t), failed = unrecorded_output(arg, res, iw, w, mem);
    res[0][F_RL] = record_value(record_F_rl, i, t);
    res[0][F_RR] = record_value(record_F_rr, i, t);
    return failed;
}

static int recorded_forward(const double **arg, double **res, long long *iw, double *w, int mem) {
    double along = arg[3][CLOCK];
    int i = record_at(arg[0][CLOCK]), failed = unrecorded_forward(arg, res, iw, w, mem);
    res[0][F_RL] = record_slope(record_F_rl, i) * along;
    res[0][F_RR] = record_slope(record_F_rr, i) * along;
    return failed;
}

WC_LOCAL const wc_kernel replay_kernel = {
    SIZES, unrecorded_nominal,
    .start = unrecorded_start, .project = unrecorded_project, .step = unrecorded_step, .output = recorded_output,
    .forward = recorded_forward, .rate = unrecorded_rate, .mass = unrecorded_mass};
