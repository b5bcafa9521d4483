
#if SOLVER
/* The memory of the start at the nominal state. */
static void begin_solver(MODEL *m)
{
    int i;
    for (i = 0; i < SOLVER_CONSTANTS; i++) m->solver[solver_constants[i].at] = solver_constants[i].value;
    keep(start_values, m->solver, LAYOUT);
    solver_sample(m->solver);
}
#endif

#if PARAMETERS
enum { START_PARTS = 16 };

/* Accelerations and multipliers of a state, from nothing. */
static void accelerate(double *r)
{
    int i;
    for (i = 0; i < N + M; i++) r[W + i] = 0.0;
    settle(r, solver_acceleration, W, N + M);
}
#endif

#if !EXPLICIT && (PARAMETERS || SAMPLED || LEVELS > 1)
/* a = w(t + shift) to first order, as the scheme has it. */
static void shift_accelerations(double *r, double shift)
{
    saved state;
    double now = r[TIME];
    int i;
    keep(r + Q, state.of, 4 * N + M);
    for (i = 0; i < N; i++) {
        double speed = r[V + i], acceleration = r[W + i];
        r[Q + i] += shift * (speed + 0.5 * shift * acceleration);
        r[V + i] += shift * acceleration;
    }
    r[TIME] = now + shift;
    settle(r, solver_acceleration, W, N + M);
    keep(r + W, state.of + (A - Q), N);
    keep(state.of, r + Q, 4 * N + M);
    r[TIME] = now;
}
#endif

#if !EXPLICIT
/* From a consistent state; each finer level has half the steps of the one before. */
static void begin_motion(MODEL *m, const double *state)
{
    int level, i;
    for (level = 0; level < LEVELS; level++) {
        STEPPER *s = &m->levels[level].shared;
#if LEVELS > 1
        if (level > 0) shift_accelerations(m->solver, START_SHIFT / (1 << level));
#endif
        for (i = 0; i < CONSTANTS; i++) s->r[constants[i].at] = constants[i].value;
        keep(state, s->r, LAYOUT);
        sample(s->r);
        begin(s);
#if CONTROLLED
        m->levels[level].is_alone = 0;
#endif
    }
#if CONTROLLED && SWITCHES
    for (i = 0; i < SWITCH_CONSTANTS; i++) m->switches[switch_constants[i].at] = switch_constants[i].value;
    keep(state, m->switches, LAYOUT);
    switch_sample(m->switches);
#endif
#if LEVELS > 1
    begin_closure(m, state);
#endif
}
#endif

void MODEL_START(MODEL *m)
{
    memset(m, 0, sizeof *m);
#if SOLVER
    begin_solver(m);
    begin_motion(m, m->solver);
#else
    begin_motion(m, start_values);
#endif
}

#if PARAMETERS
/* Whether the constraints hold. */
static int is_closed(const double *r, const int *residuals, int count)
{
    int i;
    for (i = 0; i < count; i++)
        if (!(fabs(r[residuals[i]]) <= CLOSED)) return 0;
    return 1;
}

/* The start of other parameters, from the nominal one by so many changes of them; returns 1 where there is none. */
static int assemble(double *r, const double *parameters, int parts)
{
    int part, i;
    for (part = 1; part <= parts; part++) {
        set_parameters(r, parameters, part, parts);
        solver_sample(r);
        solver_given(r);
        settle(r, solver_position, Q, N);
    }
    solver_position(r);
    if (!is_closed(r, closures, CLOSURES)) return 1;
    for (i = 0; i < N; i++) r[V + i] = 0.0;
    solver_given(r);
    settle(r, solver_velocity, V, N);
    solver_velocity(r);
    if (!is_closed(r, closure_rates, CLOSURE_RATES)) return 1;
    accelerate(r);
#if SAMPLED
    change_sampled(r, solver_sampling, solver_values);
    accelerate(r);
#endif
    return 0;
}

static int is_far(const double *r)
{
    int i;
    for (i = 0; i < N; i++)
        if (!(fabs(r[Q + i] - start_values[Q + i]) <= 0.25 * scale[i])) return 1;
    return 0;
}

/* A start that is far from the nominal one is reached by small changes, which keep it on its branch. */
static int is_assembled(MODEL *m, const double *parameters)
{
#if EQUILIBRIUM
    int at_once = balance_at(m, parameters, 1);
    if (!at_once || is_far(m->balance))
        if (!balance_at(m, parameters, START_PARTS) && !(at_once && balance_at(m, parameters, 1))) return 0;
    keep(m->balance + Q, m->solver + Q, N);
    return !assemble(m->solver, parameters, 1);
#else
    int is_open = assemble(m->solver, parameters, 1);
    if (!is_open && !is_far(m->solver)) return 1;
    begin_solver(m);
    if (!assemble(m->solver, parameters, START_PARTS)) return 1;
    begin_solver(m);
    return !is_open && !assemble(m->solver, parameters, 1);
#endif
}

int MODEL_START_AT(MODEL *m, const double *parameters)
{
    int i, is_nominal = 1;
    for (i = 0; i < PARAMETERS; i++) is_nominal = is_nominal && parameters[i] == parameter_values[i];
    MODEL_START(m);
    if (is_nominal) return 0;
    if (!is_assembled(m, parameters)) return 1;
#if !EXPLICIT
    shift_accelerations(m->solver, START_SHIFT);
#endif
    begin_motion(m, m->solver);
    return 0;
}

/* Accelerations and multipliers jump with a force: the motion begins anew from its positions and velocities. */
void MODEL_SET(MODEL *m, int parameter, double value)
{
#if EXPLICIT
    m->solver[PARAMETER + parameter] = m->closure[PARAMETER + parameter] = value;
    closure_sample(m->closure);
    solver_sample(m->solver);
    /* The step that is open is taken anew from here. */
    if (m->open > m->now && m->steps > 0) m->steps--;
    keep(m->motion, m->state, 2 * N);
    m->time = m->open = m->now;
    rate(m, m->time, m->state, m->rates[0]);
#else
    int level;
    for (level = 0; level < LEVELS; level++) {
        STEPPER *s = &m->levels[level].shared;
        s->r[PARAMETER + parameter] = value;
        keep(s->r, m->solver, LAYOUT);
        solver_sample(m->solver);
        accelerate(m->solver);
        shift_accelerations(m->solver, START_SHIFT / (1 << level));
        keep(m->solver, s->r, LAYOUT);
        sample(s->r);
        begin(s);
#if CONTROLLED
        if (m->levels[level].is_alone) detach(&m->levels[level], m->levels[level].h, NULL);
#endif
    }
#if CONTROLLED && SWITCHES
    m->switches[PARAMETER + parameter] = value;
    switch_sample(m->switches);
#endif
#if LEVELS > 1
    m->closure[PARAMETER + parameter] = value;
    closure_sample(m->closure);
#endif
#endif
}
#endif
