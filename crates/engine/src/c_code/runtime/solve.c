
/* Corrections of values until they settle; returns whether they do. */
static int settle(double *r, void (*correction)(double *), int at, int count)
{
    const double settled = 1e-14, stalled = 1e-8;
    double last = NAN;
    int k, i;
    for (k = 0; k < 40; k++) {
        double size = 0.0, relative;
        correction(r);
        for (i = 0; i < count; i++) {
            double change = r[CORRECTION + i];
            r[at + i] += change;
            relative = fabs(change) / fmax(i < N ? scale[i] : 1.0, fabs(r[at + i]));
            if (!(relative <= size)) size = relative;
        }
        if (!isfinite(size)) return 0;
        if (size <= settled || (size <= stalled && size >= 0.5 * last)) return 1;
        last = size;
    }
    return 0;
}

#if SAMPLED
/* States that change at the multiples of a period: registers of the state and of its new value. */
static int is_due(int which, double time)
{
    double periods = time / sampled_periods[which];
    return fabs(periods - round(periods)) <= INSTANT_ROUNDING;
}

static int is_instant(double time)
{
    int i;
    for (i = 0; i < SAMPLED; i++)
        if (is_due(i, time)) return 1;
    return 0;
}

/* The first instant between two times, or the second. */
static double instant_before(double from, double to)
{
    double first = to;
    int i;
    for (i = 0; i < SAMPLED; i++) {
        double number = floor(from / sampled_periods[i] + INSTANT_ROUNDING) + 1.0;
        if (number < to / sampled_periods[i] - INSTANT_ROUNDING) first = fmin(first, number * sampled_periods[i]);
    }
    return first;
}

/* Gives the states their new values; all are taken before one changes, as a value may be another of them. */
static void change_sampled(double *r, void (*sampling)(double *), const int *values)
{
    double found[SAMPLED];
    int i;
    sampling(r);
    for (i = 0; i < SAMPLED; i++) found[i] = r[values[i]];
    for (i = 0; i < SAMPLED; i++)
        if (is_due(i, r[TIME])) r[sampled_states[i]] = found[i];
}
#endif
