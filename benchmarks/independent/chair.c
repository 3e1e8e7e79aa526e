/* A rigid chair with its user on two rear wheels and two swivelling casters, moving in the plane.
 *
 * Axes: x forward, y right, yaw clockwise seen from above. Classical Runge-Kutta of fourth order with a fixed step.
 * The enumerations of the parameters (P_...) and of the outputs (O_...) are put in front of this file when it is compiled:
 * chair.py writes them, so there is one list of names.
 *
 * Tyres are bristles: a lateral deflection e of the patch grows with the sideways speed and fades with the distance rolled,
 *   e' = -v_y + |v_x| * camber - (|v_x| / sigma + v_y^2 / (|v| e_max)) e,
 * and the force is F_max * tanh(C e / (sigma F_max)). No slip angle is ever divided by a speed, so standstill, spinning on
 * the spot and reverse need no special case. On a slippery floor rear wheels turn on their own, and bristles along the wheel share
 * F_max with those across it: what is asked for together is cut to F_max by one tanh. */
#include <math.h>
#include <string.h>

#ifdef _WIN32
#define EXPORT __declspec(dllexport)
#else
#define EXPORT
#endif

enum { X, Y, PSI, U, V, R, SWIVEL_R, SWIVEL_RATE_R, SWIVEL_L, SWIVEL_RATE_L, E_RR, E_RL, E_FR, E_FL, TRUNK, LEAN, LEAN_RATE,
    RIM_R, RIM_L, ALONG_R, ALONG_L, STATES };

#define WAVES 9
#define GIVEN 3 /* inputs: pushes of the right and the left hand, and what the rider's body is about to do by itself */

static const double CREEP = 0.002;      /* m/s, within which rolling resistance changes its sign */
static const double SWIVEL_CREEP = 0.05; /* rad/s, the same for the swivel bearing */
static const double SCRUB_CREEP = 0.01; /* rad/s, the same for the yaw of the patches */
static const double TURN_STILL = 0.02;  /* m/s, below which a wheel counts as standing where its patch is turned */
static const double PIVOT_LENGTH = 0.04; /* m, turn_length of a patch that slides easily */
static const double STILL = 1e-3;       /* m/s, rounds |v_x| */
static const double DAMPING = 0.01;     /* s, of the carcass of a standing tyre */
static const double STABLE = 1.5;       /* of the 2.78 that the method bears: a step times the fastest rate */
static const double ALONG_STIFFNESS = 2e4, ALONG_LENGTH = 0.1; /* N, m: of the bristles along a rear wheel that slips */
static const double RIM_MASS = 1.457;   /* kg, spin inertia of a rear wheel, 0.14 kg m2, over its radius squared, 0.31 m */
static const double SOFTENED = 0.32;    /* share of rolling resistance that goes as one over the pressure: a third more at half of it */
static const double TORSO = 0.3;        /* m, from the hips up to where the upper body's share of the CM turns about them */
static const double TIRING = 160;       /* N of push, beyond which nobody leans much farther */

typedef struct { double force, deflection_rate; } Tyre;

static double rounded(double v) { return sqrt(v * v + STILL * STILL); }

static double forward(double v) { return v / sqrt(v * v + 4e-4); }

/* Lateral force of a tyre whose patch moves with (vx, vy) in the wheel's own frame. */
static Tyre tyre(double e, double vx, double vy, double stiffness, double sigma, double limit, double lean) {
    Tyre out;
    double speed = rounded(vx), total = sqrt(speed * speed + vy * vy);
    double fade = speed / sigma + vy * vy / total * stiffness / (3 * sigma * limit);
    double standing = DAMPING / (1 + vx * vx / 0.01);
    out.deflection_rate = -vy + (speed - STILL) * lean - fade * e;
    out.force = limit * tanh(stiffness / sigma * (e + standing * out.deflection_rate) / limit);
    return out;
}

/* The same of a wheel whose rim is faster than its hub by `spin`: forces across it and along it, and the rates of both deflections,
 * within one limit. Bristles that slide lie the way they are dragged, bent the more the faster, which only their memory feels. */
static Tyre slipping(double e, double along, double spin, double vx, double vy, double stiffness, double sigma, double limit,
                     double lean, double *pull, double *along_rate) {
    Tyre out;
    double speed = rounded(vx), slid = sqrt(spin * spin + vy * vy), slide = slid / (1 + slid), standing = DAMPING / (1 + vx * vx / 0.01);
    double across_k = stiffness / sigma, along_k = ALONG_STIFFNESS / ALONG_LENGTH;
    out.deflection_rate = -vy + (speed - STILL) * lean - (speed / sigma + slide * across_k / (3 * limit)) * e;
    *along_rate = spin - (speed / ALONG_LENGTH + slide * along_k / (3 * limit)) * along;
    double across = across_k * (e + standing * out.deflection_rate), ahead = along_k * (along + standing * *along_rate);
    double asked = sqrt(across * across + ahead * ahead) / limit, cut = asked > 1e-9 ? tanh(asked) / asked : 1;
    out.force = cut * across;
    *pull = cut * ahead;
    return out;
}

/* Torque that a patch resists with while it turns at `rate` and its wheel rolls at `speed`; `most` on the spot. */
static double turned(double most, double length, double rate, double speed) {
    return -most * tanh(length * rate / sqrt(speed * speed + TURN_STILL * TURN_STILL));
}

/* Torque of a patch that turns at `rate`, as a brush: each bristle is twisted while it goes through the patch, of `length`, and
 * slides where its twist would ask for more than friction has. On the spot all slide, and the torque is `most`. */
static double pivoted(double most, double length, double rate, double speed) {
    double twist = length * fabs(rate) / (speed + 1e-6) / 3; /* 1 where all slide */
    double held = twist < 1 ? 1 - twist : 0;
    return -most * (1 - held * held * held) * tanh(rate / SCRUB_CREEP);
}

/* A wheel's part of its axle's load; at least 1 N, as this chair does not tip over. */
static double share_of(double load, double share) { return load * share > 1 ? load * share : 1; }

/* Slope of an uneven floor at a place in the room: waves 0.7 to 4 m long that run all ways, and no two alike. */
static void uneven(const double *p, double x, double y, double *slope_x, double *slope_y) {
    double sum_x = 0, sum_y = 0;
    for (int i = 0; i < WAVES; i++) {
        double way = 2.39996 * i, length = 0.7 * pow(4 / 0.7, (double)i / (WAVES - 1)), k = 2 * 3.14159265358979 / length;
        double wave = cos(k * (x * cos(way) + y * sin(way)) + 1.7 * i * i);
        sum_x += wave * cos(way);
        sum_y += wave * sin(way);
    }
    *slope_x = p[P_slope_x] + p[P_floor] * 2 / sqrt(WAVES) * sum_x;
    *slope_y = p[P_slope_y] + p[P_floor] * 2 / sqrt(WAVES) * sum_y;
}

/* An upper body that turns about the hips, by an angle from upright, towards one that the push asks for, and the rider besides, who
 * means to have the CM forward by `urge`: a spring as of a pendulum, and a damping that grows with the speed. It goes on swinging
 * once the push is over. Returns the angle's second rate. */
static double leaning(const double *p, double angle, double rate, double push, double urge) {
    double omega = 2 * 3.14159265358979 * p[P_lean_frequency];
    double wanted = (p[P_lean] * push / 80 / sqrt(1 + push * push / (TIRING * TIRING)) + urge) / TORSO;
    return -omega * omega * sin(angle - wanted) - (p[P_lean_damping] * omega + p[P_lean_drag] * fabs(rate)) * rate;
}

/* Rates of all states, and what the instruments need, for the pushes and the urge F (right, left, urge) and their slopes dF. */
static void rates(const double *p, const double *s, const double *F, const double *dF, double *d, double *out) {
    double u = s[U], v = s[V], r = s[R];
    double angle_rate = p[P_lean] != 0 ? leaning(p, s[LEAN], s[LEAN_RATE], F[0] + F[1], F[2]) : 0;
    double shift = s[TRUNK] + TORSO * sin(s[LEAN]);
    double target = p[P_trunk] * (F[0] + F[1]) / 80;
    double trunk_rate = p[P_trunk] != 0 ? (target - s[TRUNK]) / p[P_trunk_lag] : 0;
    double shift_rate = trunk_rate + TORSO * cos(s[LEAN]) * s[LEAN_RATE];
    double shift_acceleration = p[P_trunk] != 0 ? (p[P_trunk] * (dF[0] + dF[1]) / 80 - trunk_rate) / p[P_trunk_lag] : 0;
    shift_acceleration += TORSO * (cos(s[LEAN]) * angle_rate - sin(s[LEAN]) * s[LEAN_RATE] * s[LEAN_RATE]);
    double a = p[P_a] - shift, b = p[P_b] + shift;
    double carried = a - p[P_patch_load] * p[P_trail] * (cos(s[SWIVEL_R]) + cos(s[SWIVEL_L])) / 2, base = carried + b;
    double frame = u - shift_rate;
    double c = cos(s[PSI]), n = sin(s[PSI]);
    double slope_x = p[P_slope_x], slope_y = p[P_slope_y];
    if (p[P_floor] != 0) uneven(p, s[X], s[Y], &slope_x, &slope_y);
    double gx = p[P_g] * (slope_x * c + slope_y * n);
    double gy = p[P_g] * (-slope_x * n + slope_y * c + p[P_cross_slope]);
    double weight = p[P_m] * p[P_g];
    double y_r[2] = {p[P_t_r] / 2 - p[P_y_cm], -p[P_t_r] / 2 - p[P_y_cm]};
    double y_f[2] = {p[P_t_f] / 2 - p[P_y_cm], -p[P_t_f] / 2 - p[P_y_cm]};
    double toe[2] = {p[P_toe_r], p[P_toe_l]}, camber[2] = {p[P_camber_r], p[P_camber_l]};
    double felt_x = 0, felt_y = 0, u_dot = 0, v_dot = 0, r_dot = 0, wheel[2];
    int passes = p[P_h_x] != 0 || p[P_h_y] != 0 ? 4 : 1; /* loads and accelerations need one another */

    for (int pass = 0; pass < passes; pass++) {
        double rear = weight * carried / base + p[P_m] * felt_x * p[P_h_x] / base;
        double front = weight - rear;
        double FX = p[P_m] * gx - p[P_aero] * u * fabs(u);
        double FY = p[P_m] * gy;
        double MZ = -p[P_scrub] * tanh(r / SCRUB_CREEP) - p[P_scrub_viscous] * r + p[P_wobble] * n + p[P_speed_torque] * u * u;
        for (int i = 0; i < 2; i++) { /* rear wheels, right and left */
            double side = i == 0 ? 1 : -1;
            double load = share_of(rear, 0.5 + side * (p[P_y_cm] - felt_y * p[P_h_y] / p[P_g]) / p[P_t_r]);
            double ct = cos(toe[i]), st = sin(toe[i]);
            double hx = frame - y_r[i] * r, hy = v - b * r;
            double vx = ct * hx + st * hy, vy = -st * hx + ct * hy;
            double stiffness = p[P_C_lambda] * p[P_pressure];
            if (p[P_load_exponent] != 0) stiffness *= pow(load / 400, p[P_load_exponent]);
            double limit = load / (p[P_inv_mu] + p[P_slippery]), lean = p[P_C_phi] * camber[i] / stiffness;
            double rolled = p[P_slippery] != 0 ? s[RIM_R + i] : vx, grip = 0;
            Tyre t = p[P_slippery] != 0
                ? slipping(s[E_RR + i], s[ALONG_R + i], rolled - vx, vx, vy, stiffness, p[P_sigma], limit, lean, &grip, &d[ALONG_R + i])
                : tyre(s[E_RR + i], vx, vy, stiffness, p[P_sigma], limit, lean);
            double slip = s[E_RR + i] / p[P_sigma];
            double trail = p[P_C_m_lambda] / p[P_C_lambda] / sqrt(1 + p[P_inv_slip] * p[P_inv_slip] * slip * slip)
                / (p[P_pressure] * sqrt(p[P_pressure]));
            double moment = forward(vx) * (-trail * (t.force - p[P_C_phi] * camber[i]) + p[P_C_m_phi] * camber[i])
                + turned(p[P_turn], p[P_turn_length], r, sqrt(vx * vx + vy * vy))
                + pivoted(p[P_pivot], PIVOT_LENGTH, r, sqrt(vx * vx + vy * vy));
            double rolling = tanh(rolled / CREEP);
            double soft = 1 - SOFTENED + SOFTENED / p[P_pressure];
            double drag = (p[P_f_r] * soft * load - side * p[P_drag_difference] / 2) * rolling + p[P_drag_speed] * load / weight * rolled;
            if (i == 0) drag += p[P_sticky] * rolling * 0.5 * (1 + tanh(r / 0.02));
            double pull = F[i] - drag;
            if (p[P_slippery] != 0) {
                d[RIM_R + i] = (pull - grip) / RIM_MASS;
                pull = grip;
            }
            double fx = ct * pull - st * t.force, fy = st * pull + ct * t.force;
            FX += fx;
            FY += fy;
            MZ += -b * fy - y_r[i] * fx + moment;
            d[E_RR + i] = t.deflection_rate;
            wheel[i] = rolled + p[P_slip_compliance] * pull * fabs(vx);
        }
        for (int i = 0; i < 2; i++) { /* casters, right and left */
            double side = i == 0 ? 1 : -1;
            double load = share_of(front, 0.5 + side * (p[P_y_cm] - felt_y * p[P_h_y] / p[P_g]) / p[P_t_f]);
            double angle = s[SWIVEL_R + 2 * i], rate = s[SWIVEL_RATE_R + 2 * i];
            double cd = cos(angle), sd = sin(angle);
            double px = frame - y_f[i] * r, py = v + a * r;
            double vx = cd * px + sd * py, vy = -sd * px + cd * py - p[P_trail] * (r + rate);
            Tyre t = tyre(s[E_FR + i], vx, vy, p[P_C_caster], p[P_sigma_caster], load, 0);
            double drag = p[P_f_f] * load * tanh(vx / CREEP) + p[P_drag_speed] * load / weight * vx;
            double bearing = -p[P_swivel_dry] * tanh(rate / SWIVEL_CREEP) - p[P_swivel_viscous] * rate
                - p[P_swivel_spring] * sd;
            double fx = -cd * drag - sd * t.force, fy = -sd * drag + cd * t.force;
            FX += fx;
            FY += fy;
            MZ += a * fy - y_f[i] * fx - bearing;
            d[E_FR + i] = t.deflection_rate;
            d[SWIVEL_R + 2 * i] = rate;
            d[SWIVEL_RATE_R + 2 * i] = (bearing - p[P_trail] * t.force + turned(p[P_turn_f], p[P_turn_length_f], r + rate, vx))
                / p[P_I_swivel];
        }
        { /* the spin of both rear wheels counts along their headings only */
            double half = p[P_m_spin] / 2, sum = y_r[0] + y_r[1], squares = y_r[0] * y_r[0] + y_r[1] * y_r[1];
            double m11 = p[P_m] + 2 * half, m12 = -half * sum, m22 = p[P_I_z] + half * squares;
            double b1 = FX + p[P_m] * v * r + 2 * half * shift_acceleration, b2 = MZ - half * sum * shift_acceleration;
            double det = m11 * m22 - m12 * m12;
            u_dot = (m22 * b1 - m12 * b2) / det;
            r_dot = (m11 * b2 - m12 * b1) / det;
            v_dot = FY / p[P_m] - u * r;
        }
        felt_x = u_dot - v * r - gx;
        felt_y = v_dot + u * r - gy;
    }
    for (int i = 0; i < 2; i++) d[SWIVEL_RATE_R + 2 * i] -= r_dot; /* the swivel inertia feels the absolute rotation */
    d[X] = u * c - v * n;
    d[Y] = u * n + v * c;
    d[PSI] = r;
    d[U] = u_dot;
    d[V] = v_dot;
    d[R] = r_dot;
    d[TRUNK] = trunk_rate;
    d[LEAN] = s[LEAN_RATE];
    d[LEAN_RATE] = angle_rate;
    if (!out) return;
    out[O_wheel_speed_l] = wheel[1];
    out[O_wheel_speed_r] = wheel[0];
    out[O_yaw_rate] = r;
    out[O_a_x] = felt_x - shift_acceleration + shift * r * r; /* the frame carries the accelerometer, behind the CM */
    out[O_a_y] = felt_y - 2 * shift_rate * r - shift * r_dot;
    out[O_x] = s[X] - shift * c;
    out[O_y] = s[Y] - shift * n;
    out[O_yaw] = s[PSI];
    out[O_u] = frame;
    out[O_v] = v - shift * r;
    out[O_yaw_acceleration] = r_dot;
    out[O_swivel_r] = s[SWIVEL_R];
    out[O_swivel_l] = s[SWIVEL_L];
    out[O_body] = shift;
    out[O_energy] = 0.5 * p[P_m] * (u * u + v * v) + 0.5 * p[P_I_z] * r * r;
    for (int i = 0; i < 2; i++) {
        double q = r + s[SWIVEL_RATE_R + 2 * i];
        double limit = weight * carried / base / 2 / p[P_inv_mu], k = p[P_C_lambda] / p[P_sigma];
        double kf = p[P_C_caster] / p[P_sigma_caster], lf = weight * b / base / 2;
        out[O_energy] += 0.5 * p[P_I_swivel] * q * q - p[P_swivel_spring] * cos(s[SWIVEL_R + 2 * i]);
        out[O_energy] += limit * limit / k * log(cosh(k * s[E_RR + i] / limit)) + lf * lf / kf * log(cosh(kf * s[E_FR + i] / lf));
    }
}

/* How many steps a sample takes where a caster stands: its carcass damps the swivel faster than anything else moves, and the more so
 * the longer the trail. Larger steps do not diverge, as friction limits the force, but chatter, and read as a force. */
static int fewest(const double *p, double interval) {
    double rate = DAMPING * p[P_C_caster] / p[P_sigma_caster] * p[P_trail] * p[P_trail] / p[P_I_swivel];
    return (int)ceil(interval * rate / STABLE);
}

/* Outputs at n samples, interval apart, by `steps` from one to the next, or by more where this chair asks for more; the pushes are
 * linear between samples. The accelerations of a sample are the mean of those just before and just after it, as the pushes bend
 * there. */
EXPORT void simulate(const double *p, const double *start, int n, const double *push, double interval, int steps, double *out) {
    if (steps < fewest(p, interval)) steps = fewest(p, interval);
    double s[STATES], k1[STATES], k2[STATES], k3[STATES], k4[STATES], w[STATES], h = interval / steps, none[GIVEN] = {0};
    memcpy(s, start, sizeof s);
    memset(k1, 0, sizeof k1);
    for (int k = 0; k < n; k++) {
        const double *F = push + GIVEN * k, *next = k + 1 < n ? F + GIVEN : F, *last = k > 0 ? F - GIVEN : F;
        double slope[GIVEN], centre[GIVEN];
        for (int i = 0; i < GIVEN; i++) {
            slope[i] = (next[i] - F[i]) / interval;
            centre[i] = (next[i] - last[i]) / ((k > 0 && k + 1 < n ? 2 : 1) * interval);
        }
        rates(p, s, F, n > 1 ? centre : none, k1, out + k * OUTPUTS);
        if (k + 1 == n) break;
        for (int j = 0; j < steps; j++) {
            double Fa[GIVEN], Fm[GIVEN], Fe[GIVEN];
            for (int i = 0; i < GIVEN; i++) {
                Fa[i] = F[i] + slope[i] * j * h;
                Fm[i] = F[i] + slope[i] * (j + 0.5) * h;
                Fe[i] = F[i] + slope[i] * (j + 1) * h;
            }
            rates(p, s, Fa, slope, k1, 0);
            for (int i = 0; i < STATES; i++) w[i] = s[i] + 0.5 * h * k1[i];
            rates(p, w, Fm, slope, k2, 0);
            for (int i = 0; i < STATES; i++) w[i] = s[i] + 0.5 * h * k2[i];
            rates(p, w, Fm, slope, k3, 0);
            for (int i = 0; i < STATES; i++) w[i] = s[i] + h * k3[i];
            rates(p, w, Fe, slope, k4, 0);
            for (int i = 0; i < STATES; i++) s[i] += h / 6 * (k1[i] + 2 * k2[i] + 2 * k3[i] + k4[i]);
        }
    }
}
