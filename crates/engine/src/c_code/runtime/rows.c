
#if SAMPLED
/* At an instant states take their new values, and accelerations and multipliers those that follow. */
static void change(MODEL *m, int level, double time)
{
    LEVEL *own = &m->levels[level];
    STEPPER *s = &own->shared;
    int i;
    keep(s->r + Q, m->solver + Q, 4 * N + M);
    m->solver[TIME] = time;
    change_sampled(m->solver, solver_sampling, solver_values);
    settle(m->solver, solver_acceleration, W, N + M);
    shift_accelerations(m->solver, SHIFT * s->step_size);
    for (i = 0; i < 3 * N + M; i++)
        if (isfinite(m->solver[V + i])) s->r[V + i] = m->solver[V + i];
    forget(s);
#if CONTROLLED
    if (own->is_alone) {
        double next = own->h;
        detach(own, s->step_size, NULL);
        own->h = next;
    }
#endif
}
#endif

/* A step between instants: on each level twice as many as on the one before. */
static int take_part(MODEL *m, double h, double end, int refines)
{
    int level, part;
    for (level = 0; level < LEVELS; level++) {
        int parts = 1 << level;
        for (part = 1; part <= parts; part++) {
            double size = h / parts;
            if (!take_step(m, level, size, end - (parts - part) * size, refines && part == parts)) return 1;
        }
#if SAMPLED
        if (is_instant(end)) change(m, level, end);
#endif
    }
    return 0;
}

int MODEL_STEP(MODEL *m, double h, double end, int refines)
{
#if SAMPLED
    double from = end - h, next;
    while ((next = instant_before(from, end)) < end) {
        if (take_part(m, next - from, next, 0)) return 1;
        from = next;
    }
    /* An undivided step keeps its length, to the bit. */
    return take_part(m, from == end - h ? h : end - from, end, refines);
#else
    return take_part(m, h, end, refines);
#endif
}

#if LEVELS > 1
/* The levels' motions, combined so that the leading terms of their errors cancel. */
void MODEL_OBSERVE(MODEL *m, double *outputs)
{
    double motion[2 * N + 1];
    int level, i;
    for (i = 0; i < 2 * N; i++) {
        motion[i] = 0.0;
        for (level = 0; level < LEVELS; level++) motion[i] += level_weights[level] * m->levels[level].shared.r[Q + i];
    }
    close_motion(m, m->levels[0].shared.r[TIME], motion);
    observe_motion(m, m->levels[0].shared.r[TIME], motion, outputs);
}
#else
void MODEL_OBSERVE(MODEL *m, double *outputs)
{
    STEPPER *s = &m->levels[0].shared;
    int i;
#if SOLVES || PROJECTS
    /* Velocities, accelerations and multipliers that fit this row; the steps go on with their own. */
    saved own;
    int settled = 1;
    keep(s->r + Q, own.of, 4 * N + M);
    keep(s->r + Q, m->solver + Q, 4 * N + M);
    m->solver[TIME] = s->r[TIME];
#if PROJECTS
    settled = settle(m->solver, solver_projection, V, N) && settled;
#endif
#if SOLVES
    settled = settle(m->solver, solver_acceleration, W, N + M) && settled;
#endif
    for (i = 0; i < 3 * N + M; i++) settled = settled && isfinite(m->solver[V + i]);
    if (settled) keep(m->solver + V, s->r + V, 3 * N + M);
#endif
    observe(s->r);
    for (i = 0; i < OUTPUTS; i++) outputs[i] = s->r[output_registers[i]];
#if SOLVES || PROJECTS
    keep(own.of, s->r + Q, 4 * N + M);
#endif
}
#endif

#if FIXED
int MODEL_ROW(MODEL *m, int row)
{
    int run, k;
    for (run = row_runs[row]; run < row_runs[row + 1]; run++)
        for (k = 1; k <= runs[run].count; k++) {
            int is_last = run + 1 == row_runs[row + 1] && k == runs[run].count;
            double end = is_last ? row_times[row] : runs[run].start + k * runs[run].h;
            if (MODEL_STEP(m, runs[run].h, end, ACCELERATIONS && is_last)) return 1;
        }
    return 0;
}
#else
int MODEL_ROW(MODEL *m, int row)
{
    double begin = row_times[row - 1];
    int step;
    for (step = row_steps[row]; step < row_steps[row + 1]; step++) {
        double end = step_ends[step];
        if (MODEL_STEP(m, end - begin, end, ACCELERATIONS && step + 1 == row_steps[row + 1])) return 1;
        begin = end;
    }
    return 0;
}
#endif

double MODEL_TIME(int row) { return row_times[row]; }
