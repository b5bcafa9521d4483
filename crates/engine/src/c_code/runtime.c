/* Newton's iteration of a step. It starts from extrapolated accelerations and multipliers; the matrix is factorised at the step's beginning
 * and kept for the first corrections, and the contraction that was last observed tells whether one correction is enough. */

enum { FROZEN_CORRECTIONS = 4, MOST_CORRECTIONS = 12, STEPS_BETWEEN_LOOKS = 16, MOST_HALVINGS = 10, UNKNOWNS = N + M };

#if PARAMETERS
enum { MOST_START_CORRECTIONS = 40, START_PARTS = 16 };
static const double settled = 1e-14, stalled = 1e-8;
#endif

static const double tolerance = 1e-11, first_tolerance = 1e-14, first_contraction = 0.1, contraction_safety = 10.0, least_contraction = 1e-9,
                    round_off = 4.0 * 2.220446049250313e-16;

/* Copies of w and λ, and of the whole state: q, v, a, w, λ. */
typedef struct { double of[N + M + 1]; } unknowns;
typedef struct { double of[4 * N + M + 1]; } saved;

static void keep(const double *from, double *into, int count) { memcpy(into, from, (size_t)count * sizeof *into); }

/* w and λ on the parabola through their last three values, as far as there are so many. */
static void predict(MODEL *m, int known, double h)
{
    double a = 1.0, b = 0.0, c = 0.0;
    const double *last = m->now, *second = m->now;
    int i;
    if (known == 1) {
        a = 1.0 + h / m->size_before;
        b = -h / m->size_before;
        last = m->before;
    } else if (known > 1) {
        a = 3.0;
        b = -3.0;
        c = 1.0;
        last = m->before;
        second = m->before_that;
    }
    for (i = 0; i < UNKNOWNS; i++) {
        double predicted = a * m->now[i] + (b * last[i] + c * second[i]);
        m->r[i < N ? ITERATE + i : LAMBDA + i - N] = predicted;
    }
    for (i = 0; i < REDUNDANT; i++) m->r[redundant[i]] = 0.0;
}

/* Adds the correction; returns its size in relative positions. */
static double apply(MODEL *m, double gain)
{
    double norm = 0.0, size;
    int i;
    for (i = 0; i < N; i++) {
        m->r[ITERATE + i] += m->r[CORRECTION + i];
        size = fabs(gain / scale[i] * m->r[CORRECTION + i]);
        if (!(size <= norm || isnan(norm))) norm = size;
    }
    for (i = 0; i < M; i++) m->r[LAMBDA + i] += m->r[CORRECTION + N + i];
    return norm;
}

/* Whether a pivot is too small: the configuration is singular. */
static int is_singular(const MODEL *m)
{
    int i;
    for (i = 0; i < WATCHED; i++) {
        const watched_pivot *own = &watched[i];
        double inverse = m->r[own->pivot];
        if (own->mode >= 0 && (m->r[own->mode] <= 0.0) != own->inactive) continue;
        if (isnan(inverse) || fabs(inverse) > own->largest) return 1;
    }
    return 0;
}

static int iterate(MODEL *m, double h)
{
    double gain = GAIN * h * h, last = 0.0;
    int count;
    for (count = 0; count < MOST_CORRECTIONS; count++) {
        double norm, contraction, error;
        if (count == 0 || count >= FROZEN_CORRECTIONS) {
            factor(m->r);
            if (is_singular(m)) return 0;
            first_correction(m->r);
        } else {
            correct(m->r);
        }
        norm = apply(m, gain);
        contraction = count == 0 ? m->contraction : norm / last;
        if (count == 1) m->contraction = fmax(contraction_safety * contraction, least_contraction);
        error = contraction < 1.0 ? norm * contraction / (1.0 - contraction) : INFINITY;
        last = norm;
        if (error <= (count == 0 ? first_tolerance : tolerance) || norm <= round_off) return 1;
    }
    return 0;
}

static void set_step_size(MODEL *m, double h)
{
    int i;
    if (isfinite(m->step_size) && m->step_size != h)
        for (i = 0; i < N; i++) {
            double w = m->r[W + i];
            m->r[A + i] = w + h / m->step_size * (m->r[A + i] - w);
        }
    m->step_size = h;
    if (m->prepared_size != h) {
        m->r[STEP] = h;
        step_size(m->r);
        m->prepared_size = h;
    }
}

/* One step without substeps; the state stays where it does not converge. */
static int try_step(MODEL *m, double h, double end, int refines)
{
    int converged;
    set_step_size(m, h);
    m->r[TIME] = end;
    step(m->r);
    keep(m->r + W, m->now, UNKNOWNS);
    if (h != m->size_before && m->known > 1) m->known = 1;
    predict(m, m->known, h);
    if (m->steps % STEPS_BETWEEN_LOOKS == 0) m->contraction = first_contraction;
    m->steps++;
    converged = iterate(m, h);
    if (converged && refines) {
        correct(m->r);
        apply(m, GAIN * h * h);
    }
    if (!converged) keep(m->now + N, m->r + LAMBDA, M);
    keep(m->before, m->before_that, UNKNOWNS);
    keep(m->now, m->before, UNKNOWNS);
    m->known = m->known < 2 ? m->known + 1 : 2;
    m->size_before = h;
    if (converged) advance(m->r);
    return converged;
}

static void begin(MODEL *m)
{
    m->step_size = m->prepared_size = m->size_before = NAN;
    m->contraction = first_contraction;
    m->known = 0;
    m->steps = 0;
}

int MODEL_STEP(MODEL *m, double h, double end, int refines)
{
    saved start;
    int halvings;
    if (try_step(m, h, end, refines)) return 0;
    keep(m->r + Q, start.of, 4 * N + M);
    for (halvings = 1; halvings <= MOST_HALVINGS; halvings++) {
        int parts = 1 << halvings, part, done = 1;
        MODEL alone = *m;
        begin(&alone);
        keep(start.of, alone.r + Q, 4 * N + M);
        alone.step_size = h;
        for (part = 1; part <= parts && done; part++)
            done = try_step(&alone, h / parts, end - (parts - part) * (h / parts), refines);
        if (!done) continue;
        set_step_size(&alone, h);
        keep(alone.r + Q, m->r + Q, 4 * N + M);
        return 0;
    }
    return 1;
}

#if SOLVES || PARAMETERS
/* The memory of the start at the nominal state, with these parameters. */
static void begin_solver(MODEL *m)
{
    int i;
    for (i = 0; i < SOLVER_CONSTANTS; i++) m->solver[solver_constants[i].at] = solver_constants[i].value;
    keep(start_values, m->solver, LAYOUT);
    keep(m->r + PARAMETER, m->solver + PARAMETER, PARAMETERS);
    solver_sample(m->solver);
}
#endif

static void begin_motion(MODEL *m)
{
    int i;
    memset(m, 0, sizeof *m);
    for (i = 0; i < CONSTANTS; i++) m->r[constants[i].at] = constants[i].value;
    keep(start_values, m->r, LAYOUT);
}

void MODEL_START(MODEL *m)
{
    begin_motion(m);
    sample(m->r);
    begin(m);
#if SOLVES || PARAMETERS
    begin_solver(m);
#endif
}

#if PARAMETERS
/* Corrections of values until they settle; returns whether they do. */
static int settle(double *r, void (*correction)(double *), int at, int count)
{
    double last = NAN;
    int k, i;
    for (k = 0; k < MOST_START_CORRECTIONS; k++) {
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

/* Whether the constraints hold. */
static int is_closed(const double *r, const int *residuals, int count)
{
    int i;
    for (i = 0; i < count; i++)
        if (!(fabs(r[residuals[i]]) <= CLOSED)) return 0;
    return 1;
}

static void fill(double *values, int count)
{
    int i;
    for (i = 0; i < count; i++) values[i] = 0.0;
}

/* Accelerations and multipliers of a state; a = w(t + shift) to first order, as the scheme has it. */
static void accelerate(double *r)
{
    saved state;
    double now = r[TIME];
    int i;
    fill(r + W, N + M);
    settle(r, solver_acceleration, W, N + M);
    keep(r + Q, state.of, 4 * N + M);
    for (i = 0; i < N; i++) {
        double speed = r[V + i], acceleration = r[W + i];
        r[Q + i] += START_SHIFT * (speed + 0.5 * START_SHIFT * acceleration);
        r[V + i] += START_SHIFT * acceleration;
    }
    r[TIME] = now + START_SHIFT;
    settle(r, solver_acceleration, W, N + M);
    keep(r + W, state.of + (A - Q), N);
    keep(state.of, r + Q, 4 * N + M);
    r[TIME] = now;
}

/* The start of other parameters, from the nominal one by so many changes of them; returns 1 where there is none. */
static int assemble(double *r, const double *parameters, int parts)
{
    int part, i;
    for (part = 1; part <= parts; part++) {
        for (i = 0; i < PARAMETERS; i++) {
            double nominal = parameter_values[i];
            r[PARAMETER + i] = part == parts ? parameters[i] : nominal + (double)part / parts * (parameters[i] - nominal);
        }
        solver_sample(r);
        solver_given(r);
        settle(r, solver_position, Q, N);
    }
    solver_position(r);
    if (!is_closed(r, closures, CLOSURES)) return 1;
    fill(r + V, N);
    solver_given(r);
    settle(r, solver_velocity, V, N);
    solver_velocity(r);
    if (!is_closed(r, closure_rates, CLOSURE_RATES)) return 1;
    accelerate(r);
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
    int is_open = assemble(m->solver, parameters, 1);
    if (!is_open && !is_far(m->solver)) return 1;
    begin_solver(m);
    if (!assemble(m->solver, parameters, START_PARTS)) return 1;
    begin_solver(m);
    return !is_open && !assemble(m->solver, parameters, 1);
}

int MODEL_START_AT(MODEL *m, const double *parameters)
{
    int i, is_nominal = 1;
    for (i = 0; i < PARAMETERS; i++) is_nominal = is_nominal && parameters[i] == parameter_values[i];
    MODEL_START(m);
    if (is_nominal) return 0;
    if (!is_assembled(m, parameters)) return 1;
    keep(m->solver, m->r, LAYOUT);
    sample(m->r);
    return 0;
}

/* Accelerations and multipliers jump with a force: the motion begins anew from its positions and velocities. */
void MODEL_SET(MODEL *m, int parameter, double value)
{
    m->r[PARAMETER + parameter] = value;
    keep(m->r, m->solver, LAYOUT);
    solver_sample(m->solver);
    accelerate(m->solver);
    keep(m->solver, m->r, LAYOUT);
    sample(m->r);
    begin(m);
}
#endif

void MODEL_OBSERVE(MODEL *m, double *outputs)
{
    int i;
#if SOLVES
    /* Accelerations and multipliers that fit the positions and velocities of this row; the steps go on with their own. */
    unknowns own;
    int count;
    keep(m->r + W, own.of, UNKNOWNS);
    keep(m->r + Q, m->solver + Q, 4 * N + M);
    m->solver[TIME] = m->r[TIME];
    for (count = 0; count < MOST_CORRECTIONS; count++) {
        double largest = 0.0;
        solver_acceleration(m->solver);
        for (i = 0; i < UNKNOWNS; i++) {
            double change = m->solver[CORRECTION + i];
            m->solver[W + i] += change;
            largest = fmax(largest, fabs(change) / (1e-6 + fabs(m->solver[W + i])));
        }
        if (largest < 1e-13) break;
    }
    for (i = 0; i < UNKNOWNS; i++)
        if (!isfinite(m->solver[W + i])) break;
    if (i == UNKNOWNS) keep(m->solver + W, m->r + W, UNKNOWNS);
#endif
    observe(m->r);
    for (i = 0; i < OUTPUTS; i++) outputs[i] = m->r[output_registers[i]];
#if SOLVES
    keep(own.of, m->r + W, UNKNOWNS);
#endif
}

int MODEL_ROW(MODEL *m, int row)
{
    int run, k;
    for (run = row_runs[row]; run < row_runs[row + 1]; run++)
        for (k = 1; k <= runs[run].count; k++) {
            int is_last = run + 1 == row_runs[row + 1] && k == runs[run].count;
            double end = is_last ? row_times[row] : runs[run].start + k * runs[run].h;
            if (MODEL_STEP(m, runs[run].h, end, REFINES && is_last)) return 1;
        }
    return 0;
}

double MODEL_TIME(int row) { return row_times[row]; }
