/* Newton's iteration of a step. It starts from extrapolated accelerations and multipliers; the matrix is factorised at the step's beginning
 * and kept for the first corrections, and the contraction that was last observed tells whether one correction is enough. */

enum { FROZEN_CORRECTIONS = 4, MOST_CORRECTIONS = 12, STEPS_BETWEEN_LOOKS = 16, UNKNOWNS = N + M };

static const double tolerance = 1e-11, first_tolerance = 1e-14, first_contraction = 0.1, contraction_safety = 10.0, least_contraction = 1e-9,
                    round_off = 4.0 * 2.220446049250313e-16;

/* w and λ on the parabola through their last three values, as far as there are so many. */
static void predict(STEPPER *s, int known, double h)
{
    double a = 1.0, b = 0.0, c = 0.0;
    const double *last = s->now, *second = s->now;
    int i;
    if (known == 1) {
        a = 1.0 + h / s->size_before;
        b = -h / s->size_before;
        last = s->before;
    } else if (known > 1) {
        a = 3.0;
        b = -3.0;
        c = 1.0;
        last = s->before;
        second = s->before_that;
    }
    for (i = 0; i < UNKNOWNS; i++) {
        double predicted = a * s->now[i] + (b * last[i] + c * second[i]);
        s->r[i < N ? ITERATE + i : LAMBDA + i - N] = predicted;
    }
    for (i = 0; i < REDUNDANT; i++) s->r[redundant[i]] = 0.0;
}

/* Adds the correction; returns its size in relative positions. */
static double apply(STEPPER *s, double gain)
{
    double norm = 0.0, size;
    int i;
    for (i = 0; i < N; i++) {
        s->r[ITERATE + i] += s->r[CORRECTION + i];
        size = fabs(gain / scale[i] * s->r[CORRECTION + i]);
        if (!(size <= norm || isnan(norm))) norm = size;
    }
    for (i = 0; i < M; i++) s->r[LAMBDA + i] += s->r[CORRECTION + N + i];
    return norm;
}

/* Whether a pivot is too small: the configuration is singular. */
static int is_singular(const STEPPER *s)
{
    int i;
    for (i = 0; i < WATCHED; i++) {
        const watched_pivot *own = &watched[i];
        double inverse = s->r[own->pivot];
        if (own->mode >= 0 && (s->r[own->mode] <= 0.0) != own->inactive) continue;
        if (isnan(inverse) || fabs(inverse) > own->largest) return 1;
    }
    return 0;
}

static int iterate(STEPPER *s, double h)
{
    double gain = GAIN * h * h, last = 0.0;
    int count;
    for (count = 0; count < MOST_CORRECTIONS; count++) {
        double norm, contraction, error;
        if (count == 0 || count >= FROZEN_CORRECTIONS) {
            factor(s->r);
            if (is_singular(s)) return 0;
            first_correction(s->r);
        } else {
            correct(s->r);
        }
        norm = apply(s, gain);
        contraction = count == 0 ? s->contraction : norm / last;
        if (count == 1) s->contraction = fmax(contraction_safety * contraction, least_contraction);
        error = contraction < 1.0 ? norm * contraction / (1.0 - contraction) : INFINITY;
        last = norm;
        if (error <= (count == 0 ? first_tolerance : tolerance) || norm <= round_off) return 1;
    }
    return 0;
}
