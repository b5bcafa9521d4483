
/* Steps of which each may err by its share of a tolerance, and which end where the equations switch. A step of the schedule
 * that does not is left to steps of the motion's own up to its end, which go on until they are as long as the schedule's. */

enum { MOST_OWN_STEPS = 200000, POINTS = 16, BISECTIONS = 50 };

/* Where the equations first switch in a step: as a share of it, 2 where they do not; and whether its ends do not show it. */
typedef struct { double share; int is_hidden; } crossing;

/* (value, rate) of each switch at both ends of a step. */
typedef struct { double before[2 * SWITCHES + 1], after[2 * SWITCHES + 1]; } watched_step;

static void look(MODEL *m, const double *r, double *values)
{
#if SWITCHES
    int i;
    keep(r + Q, m->switches + Q, 4 * N + M);
    m->switches[TIME] = r[TIME];
    switch_values(m->switches);
    for (i = 0; i < SWITCHES; i++) {
        values[2 * i] = m->switches[switch_registers[i].value];
        values[2 * i + 1] = switch_registers[i].rate < 0 ? NAN : m->switches[switch_registers[i].rate];
    }
#else
    (void)m; (void)r; (void)values;
#endif
}

#if SWITCHES
static double cubic(const double *start, const double *end, double h, double s)
{
    double rest = 1.0 - s;
    return rest * rest * ((1.0 + 2.0 * s) * start[0] + s * h * start[1]) + s * s * ((3.0 - 2.0 * s) * end[0] - rest * h * end[1]);
}

/* Where the cubic through values and rates first changes its sign; the line where rates are unknown. */
static crossing crossing_of(const watched_step *seen, int which, double h)
{
    const double *start = seen->before + 2 * which, *end = seen->after + 2 * which;
    crossing none = { 2.0, 0 }, found = { 2.0, 0 };
    int changes = start[0] * end[0] <= 0.0, approaches = start[0] * start[1] < 0.0 && end[0] * end[1] > 0.0, point, k;
    if (!isfinite(start[0]) || !isfinite(end[0]) || start[0] == 0.0) return none;
    if (!(isfinite(start[1]) && isfinite(end[1]))) {
        found.share = changes ? start[0] / (start[0] - end[0]) : 2.0;
        return found;
    }
    if (!(changes || approaches)) return none;
    for (point = 1; point <= POINTS; point++) {
        double before = (point - 1.0) / POINTS, beyond = (double)point / POINTS;
        if (!(cubic(start, end, h, beyond) * start[0] <= 0.0)) continue;
        for (k = 0; k < BISECTIONS; k++) {
            double middle = 0.5 * (before + beyond);
            if (cubic(start, end, h, middle) * start[0] <= 0.0) beyond = middle;
            else before = middle;
        }
        found.share = beyond;
        found.is_hidden = !changes;
        return found;
    }
    return none;
}
#endif

static crossing first_crossing(const watched_step *seen, double h)
{
    crossing first = { 2.0, 0 };
#if SWITCHES
    int i, k;
    for (i = 0; i < SWITCHES; i++) {
        crossing own = crossing_of(seen, i, h);
        int jumps = 0;
        if (own.share > 1.0) continue;
        /* What jumps where a whole number is passed has no crossing of its own there. */
        for (k = switch_registers[i].jumps; k < switch_registers[i + 1].jumps; k++)
            jumps = jumps || (jumps_with[k] != i && crossing_of(seen, jumps_with[k], h).share <= 1.0);
        if (jumps || !(own.share < first.share)) continue;
        own.is_hidden = own.is_hidden || (first.share <= 1.0 && first.is_hidden);
        first = own;
    }
#else
    (void)seen; (void)h;
#endif
    return first;
}

static int is_at_the_end(crossing found) { return !found.is_hidden && found.share >= 0.999; }

/* Error over the share of a step in the tolerance; finer levels have less. */
static double error_ratio(double error, double h, int level)
{
    double allowed = TOLERANCE / (double)(1 << 2 * level);
    return error / fmax(allowed * h / DURATION, round_off);
}

/* Begins steps of the motion's own, from a state or from the present one, where the equations have just switched. */
static void detach(LEVEL *own, double h, const saved *state)
{
    own->alone = own->shared;
    begin(&own->alone);
    if (state) keep(state->of, own->alone.r + Q, 4 * N + M);
    own->alone.step_size = own->h = h;
    own->has_switched = !state;
    own->is_alone = 1;
}

/* Tries a step towards a goal; the time stays where it is not accepted. */
static void attempt(MODEL *m, int level, double *time, double goal, int refines)
{
    LEVEL *own = &m->levels[level];
    STEPPER *s = &own->alone;
    double left = goal - *time, step = own->h, end = *time + own->h, ratio, factor, next;
    watched_step seen;
    crossing found;
    saved before;
    int converged, crosses, is_early, accepted;
    if (own->h >= left * (1.0 - 1e-9)) {
        step = left;
        end = goal;
    } else if (own->h > 0.55 * left) {
        step = 0.5 * left;
        end = *time + step;
    }
    set_step_size(s, step);
    keep(s->r + Q, before.of, 4 * N + M);
    s->r[TIME] = *time;
    look(m, s->r, seen.before);
    converged = try_step(s, step, end, refines);
    look(m, s->r, seen.after);
    found = first_crossing(&seen, step);
    crosses = found.share <= 1.0;
    ratio = error_ratio(own->has_switched || crosses ? s->whole_error : s->error, step, level);
    is_early = crosses && !own->has_switched && !is_at_the_end(found) && step > LEAST_EVENT;
    if (!converged || isnan(ratio) || is_early) ratio = INFINITY;
    accepted = ratio <= 1.0;
    factor = isfinite(ratio) ? fmin(fmax(0.9 / sqrt(ratio), 0.2), 2.0) : 0.25;
    next = step * (accepted ? factor : fmin(factor, 0.9));
    if (crosses && !accepted && step > LEAST_EVENT) own->h = fmin(fmax(step * found.share * (1.0 + 1e-6), LEAST_EVENT), 0.9 * step);
    else own->h = accepted && step < own->h && !crosses ? fmax(own->h, next) : next;
    if (accepted) {
        own->has_switched = crosses;
        *time = end;
    } else {
        keep(before.of, s->r + Q, 4 * N + M);
        s->step_size = step;
    }
}

/* Steps of the motion's own up to a time; returns whether they are long enough. */
static int go_alone(MODEL *m, int level, double time, double end, int refines)
{
    int step;
    for (step = 0; step < MOST_OWN_STEPS; step++) {
        attempt(m, level, &time, end, refines);
        if (m->levels[level].h < LEAST_STEP) return 0;
        if (time == end) return 1;
    }
    return 0;
}

static int take_step(MODEL *m, int level, double h, double end, int refines)
{
    LEVEL *own = &m->levels[level];
    STEPPER *s = &own->shared;
    double begun = s->r[TIME];
    watched_step seen;
    crossing found = { 2.0, 0 };
    saved start;
    int converged, crosses, is_within;
    set_step_size(s, h);
    keep(s->r + Q, start.of, 4 * N + M);
    look(m, s->r, seen.before);
    converged = try_step(s, h, end, refines);
    look(m, s->r, seen.after);
    if (converged) found = first_crossing(&seen, h);
    crosses = found.share <= 1.0;
    is_within = converged && error_ratio(crosses ? s->whole_error : s->error, h, level) <= 1.0 && (!crosses || is_at_the_end(found));
    if (is_within && (!own->is_alone || (own->h >= h && !own->has_switched))) {
        own->is_alone = 0;
        /* What follows a switch is not left to the schedule's steps. */
        if (crosses) detach(own, h, NULL);
        return 1;
    }
    if (!own->is_alone) detach(own, h, &start);
    if (go_alone(m, level, begun, end, refines)) {
        set_step_size(&own->alone, h);
        keep(own->alone.r + Q, s->r + Q, 4 * N + M);
        return 1;
    }
    own->is_alone = 0;
    return converged;
}
