/* The base machine by hand: what an engineer writes who needs this one model fast. Classical RK4, held valve voltage.
 *
 * The valve's characteristic depends on the held voltage alone, so it is taken out of the inner loop; constants are
 * folded once per run; branches stand where they save an evaluation of exp or sin. Compiled by bench_kernel.py.
 */
#include <math.h>

enum { STATES = 5 };

typedef struct {
    double mass, area_a, area_b, stroke;
    double supply, atmosphere, gas_constant, temperature, gamma;
    double volume_a, volume_b;
    double right_limit, left_limit, right_slope, left_slope;
    double filling, exhaust, voltage_gain;
    double static_friction, coulomb_friction, stribeck_velocity, stiffness, damping, breakaway_ratio;
    double drag;
    double stop_stiffness, stop_damping;
} Machine;

/* What stays constant while the voltage is held: flows are fill * (p_s - p) or empty * (p - p_atm), times R T gamma. */
typedef struct {
    double fill_a, empty_a, fill_b, empty_b;
} Valve;

static Valve open_valve(const Machine *m, double U)
{
    Valve w = {0.0, 0.0, 0.0, 0.0};
    const double heat = m->gamma * m->gas_constant * m->temperature;
    if (U > m->right_limit) {
        const double phi = atan(m->voltage_gain * m->right_slope * (U - m->right_limit));
        w.fill_a = phi * heat * m->filling;
        w.empty_b = phi * heat * m->exhaust;
    } else if (U < -m->left_limit) {
        const double phi = -atan(m->voltage_gain * m->left_slope * (U + m->left_limit));
        w.empty_a = phi * heat * m->exhaust;
        w.fill_b = phi * heat * m->filling;
    }
    return w;
}

static inline double bristle_rate(const Machine *m, double v, double z)
{
    if (v * z <= 0.0)
        return v;
    const double w = v / m->stribeck_velocity;
    const double g = m->coulomb_friction + (m->static_friction - m->coulomb_friction) * exp(-w * w);
    const double z_max = g / m->stiffness, z_ba = m->breakaway_ratio * z_max, depth = fabs(z);
    if (depth <= z_ba)
        return v;
    const double plastic = v * depth / z_max;
    if (depth >= z_max)
        return v - plastic;
    return v - plastic * (0.5 + 0.5 * sin(M_PI * (depth - 0.5 * (z_max + z_ba)) / (z_max - z_ba)));
}

static inline double stop_force(const Machine *m, double y, double v)
{
    const double over = y - 0.5 * m->stroke, under = -y - 0.5 * m->stroke;
    if (over > 0.0)
        return m->stop_stiffness * over * fmax(1.0 + m->stop_damping * v, 0.0);
    if (under > 0.0)
        return -m->stop_stiffness * under * fmax(1.0 - m->stop_damping * v, 0.0);
    return 0.0;
}

static inline void rates(const Machine *m, const Valve *w, const double *restrict x, double *restrict d)
{
    const double y = x[0], v = x[1], p_a = x[2], p_b = x[3], z = x[4];
    const double dz = bristle_rate(m, v, z);
    const double resist = m->stiffness * z + m->damping * dz + m->drag * v * fabs(v);
    const double gas = m->area_a * (p_a - m->atmosphere) - m->area_b * (p_b - m->atmosphere);
    const double in_a = w->fill_a * (m->supply - p_a) - w->empty_a * (p_a - m->atmosphere);
    const double in_b = w->fill_b * (m->supply - p_b) - w->empty_b * (p_b - m->atmosphere);
    d[0] = v;
    d[1] = (gas - resist - stop_force(m, y, v)) / m->mass;
    d[2] = (in_a - m->gamma * m->area_a * v * p_a) / (m->volume_a + m->area_a * y);
    d[3] = (in_b + m->gamma * m->area_b * v * p_b) / (m->volume_b - m->area_b * y);
    d[4] = dz;
}

/* Advance x through `samples` held voltages of `stride` steps of length h; out (samples, 5) after each sample. */
void run(double *x, const Machine *machine, const double *voltage, long samples, long stride, double h, double *out)
{
    const Machine m = *machine;
    double s[STATES];
    for (int i = 0; i < STATES; i++)
        s[i] = x[i];
    for (long k = 0; k < samples; k++) {
        const Valve w = open_valve(&m, voltage[k]);
        for (long n = 0; n < stride; n++) {
            double k1[STATES], k2[STATES], k3[STATES], k4[STATES], r[STATES];
            rates(&m, &w, s, k1);
            for (int i = 0; i < STATES; i++)
                r[i] = s[i] + 0.5 * h * k1[i];
            rates(&m, &w, r, k2);
            for (int i = 0; i < STATES; i++)
                r[i] = s[i] + 0.5 * h * k2[i];
            rates(&m, &w, r, k3);
            for (int i = 0; i < STATES; i++)
                r[i] = s[i] + h * k3[i];
            rates(&m, &w, r, k4);
            for (int i = 0; i < STATES; i++)
                s[i] += h / 6.0 * (k1[i] + 2.0 * (k2[i] + k3[i]) + k4[i]);
        }
        for (int i = 0; i < STATES; i++)
            out[k * STATES + i] = s[i];
    }
    for (int i = 0; i < STATES; i++)
        x[i] = s[i];
}
