/* A hand-written loop of the same method: block on two pads, Dormand-Prince 5(4)
 * from sample to sample with error control, reactions watched at every step.
 * Compiled by the benchmark; the yardstick of the integrator's speed. */
#include <math.h>
#include <string.h>

typedef struct {
    double g, h, b, inertia, k, c, delta;
} Block;

static void slope(const Block *q, const double s[4], double ax, double ay, double d[6]) {
    double sine = sin(s[0]), cosine = cos(s[0]);
    double rise = q->h * sine * sine / (1.0 + cosine);
    double below = q->delta - s[1] - rise, half = q->b * sine;
    double ll = q->h * sine + q->b * cosine, lr = q->h * sine - q->b * cosine;
    double vl = s[3] + ll * s[2], vr = s[3] + lr * s[2];
    double nl = q->k * (below - half) - q->c * vl;
    double nr = q->k * (below + half) - q->c * vr;
    double reach = q->h * cosine, bend = -q->h * sine;
    d[0] = s[2];
    d[1] = s[3];
    d[2] = (nl * ll + nr * lr - reach * (ax + bend * s[2] * s[2])) / (q->inertia + reach * reach);
    d[3] = nl + nr - q->g - ay;
    d[4] = q->c * (vl * vl + vr * vr);
    d[5] = -ax * reach * s[2] - ay * s[3];
}

static double reactions(const Block *q, const double s[4]) {
    double sine = sin(s[0]), cosine = cos(s[0]);
    double rise = q->h * sine * sine / (1.0 + cosine);
    double below = q->delta - s[1] - rise, half = q->b * sine;
    double ll = q->h * sine + q->b * cosine, lr = q->h * sine - q->b * cosine;
    double nl = q->k * (below - half) - q->c * (s[3] + ll * s[2]);
    double nr = q->k * (below + half) - q->c * (s[3] + lr * s[2]);
    return nl < nr ? nl : nr;
}

/* Returns the number of steps; *work gets the dashpot and input work. */
long integrate(const Block *q, const double *a, long n, double dt, double rtol, double floor_,
               double max_step, double s[4], double reference[4], double *out, double work[2],
               double *lowest, double *peak) {
    double k[7][6], y[4], z[4], h_next = max_step;
    long steps = 0;
    slope(q, s, a[0], 0.0, k[0]);
    memcpy(out, s, 4 * sizeof(double));
    for (long i = 0; i + 1 < n; ++i) {
        double t = 0.0, a0 = a[i], da = (a[i + 1] - a[i]) / dt;
        while (t < dt) {
            double h = fmin(fmin(h_next, max_step), dt - t);
#define STAGE(m, c, ...)                                          \
    for (int j = 0; j < 4; ++j) y[j] = s[j] + h * (__VA_ARGS__);  \
    slope(q, y, a0 + da * (t + (c) * h), 0.0, k[m]);
            STAGE(1, 1. / 5, k[0][j] / 5)
            STAGE(2, 3. / 10, 3. / 40 * k[0][j] + 9. / 40 * k[1][j])
            STAGE(3, 4. / 5, 44. / 45 * k[0][j] - 56. / 15 * k[1][j] + 32. / 9 * k[2][j])
            STAGE(4, 8. / 9,
                  19372. / 6561 * k[0][j] - 25360. / 2187 * k[1][j] + 64448. / 6561 * k[2][j] -
                      212. / 729 * k[3][j])
            STAGE(5, 1.0,
                  9017. / 3168 * k[0][j] - 355. / 33 * k[1][j] + 46732. / 5247 * k[2][j] +
                      49. / 176 * k[3][j] - 5103. / 18656 * k[4][j])
            for (int j = 0; j < 4; ++j)
                z[j] = s[j] + h * (35. / 384 * k[0][j] + 500. / 1113 * k[2][j] +
                                   125. / 192 * k[3][j] - 2187. / 6784 * k[4][j] +
                                   11. / 84 * k[5][j]);
            slope(q, z, a0 + da * (t + h), 0.0, k[6]);
            double largest = 0.0;
            for (int j = 0; j < 4; ++j) {
                double e = h * (71. / 57600 * k[0][j] - 71. / 16695 * k[2][j] +
                                71. / 1920 * k[3][j] - 17253. / 339200 * k[4][j] +
                                22. / 525 * k[5][j] - 1. / 40 * k[6][j]);
                largest = fmax(largest, fabs(e) / fmax(fabs(z[j]), floor_ * reference[j]));
            }
            largest /= rtol;
            if (!(largest <= 1.0)) {
                h_next = h * fmax(0.2, 0.9 * pow(largest, -0.2));
                continue;
            }
            if (largest > 0.5 || h < dt)
                h_next = fmax(h_next, h * fmin(5.0, 0.9 * pow(fmax(largest, 1e-12), -0.2)));
            for (int m = 4; m < 6; ++m)
                work[m - 4] += h * (35. / 384 * k[0][m] + 500. / 1113 * k[2][m] +
                                    125. / 192 * k[3][m] - 2187. / 6784 * k[4][m] +
                                    11. / 84 * k[5][m]);
            for (int j = 0; j < 4; ++j) {
                s[j] = z[j];
                reference[j] = fmax(reference[j], fabs(z[j]));
            }
            *lowest = fmin(*lowest, reactions(q, s));
            *peak = fmax(*peak, fabs(s[0]));
            memcpy(k[0], k[6], sizeof k[0]);
            t = dt - t - h < 1e-14 * dt ? dt : t + h;
            ++steps;
        }
        memcpy(out + 4 * (i + 1), s, 4 * sizeof(double));
    }
    return steps;
}
