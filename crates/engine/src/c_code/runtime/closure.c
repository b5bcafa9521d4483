
/* Positions and velocities that are no step's own: combined from several motions, or between the ends of a step. */

static void begin_closure(MODEL *m, const double *state)
{
    int i;
    for (i = 0; i < CLOSURE_CONSTANTS; i++) m->closure[closure_constants[i].at] = closure_constants[i].value;
    keep(state, m->closure, LAYOUT);
    closure_sample(m->closure);
}

/* Moves the positions and velocities onto the constraints; what cannot be moved stays. */
static void close_motion(MODEL *m, double time, double *motion)
{
    double *r = m->closure;
    r[TIME] = time;
    keep(motion, r + Q, 2 * N);
#if CLOSES
    {
        int settled = settle(r, closure_position, Q, N), i;
        for (i = 0; i < N; i++)
            if (!settled || !isfinite(r[Q + i])) r[Q + i] = motion[i];
        settle(r, closure_projection, V, N);
        keep(r + Q, motion, 2 * N);
    }
#endif
}

/* Outputs of a motion that is closed. */
static void observe_motion(MODEL *m, double time, const double *motion, double *outputs)
{
    double *r = m->closure;
    int i;
    r[TIME] = time;
    keep(motion, r + Q, 2 * N);
#if ACCELERATIONS
    settle(r, closure_acceleration, W, N + M);
#endif
    closure_observe(r);
    for (i = 0; i < OUTPUTS; i++) outputs[i] = r[closure_outputs[i]];
}
