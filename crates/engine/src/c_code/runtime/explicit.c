
/* Dormand and Prince's method of order 8. Steps are those of the schedule, whatever times the motion is asked for: between
 * their ends it is the method's dense output. */

static void rate(MODEL *m, double time, const double *state, double *into)
{
    double *r = m->closure;
    int i;
    r[TIME] = time;
    keep(state, r + Q, 2 * N);
#if LINEAR
    closure_acceleration(r);
    for (i = 0; i < N + M; i++) r[W + i] += r[CORRECTION + i];
#else
    settle(r, closure_acceleration, W, N + M);
#endif
    for (i = 0; i < N; i++) {
        into[i] = state[N + i];
        into[N + i] = r[W + i];
    }
}

static void combine(const MODEL *m, int stage, double h, double *into)
{
    int term, i;
    keep(m->state, into, 2 * N);
    for (term = stage_terms[stage]; term < stage_terms[stage + 1]; term++)
        for (i = 0; i < 2 * N; i++) into[i] += h * terms[term].weight * m->rates[terms[term].stage][i];
}

static void evaluate_stage(MODEL *m, int stage, double h)
{
    double state[2 * N + 1];
    combine(m, stage, h, state);
    rate(m, m->time + stage_times[stage] * h, state, m->rates[stage]);
}

/* The terms of the dense output of the step that ends at `m->open`. */
static void prepare_dense(MODEL *m)
{
    double h = m->open - m->time;
    int stage, term, k, i;
    for (stage = STAGES; stage < WITH_DENSE; stage++) evaluate_stage(m, stage, h);
    for (i = 0; i < 2 * N; i++) {
        double old = m->rates[0][i], new = m->rates[STAGES - 1][i], change = m->next[i] - m->state[i];
        m->dense[0][i] = change;
        m->dense[1][i] = h * old - change;
        m->dense[2][i] = 2.0 * change - h * (new + old);
    }
    for (k = 0; k < 4; k++) {
        double *into = m->dense[3 + k];
        for (i = 0; i < 2 * N; i++) into[i] = 0.0;
        for (term = stage_terms[WITH_DENSE + k]; term < stage_terms[WITH_DENSE + k + 1]; term++)
            for (i = 0; i < 2 * N; i++) into[i] += h * terms[term].weight * m->rates[terms[term].stage][i];
    }
}

/* End of the next step; behind the schedule its last length goes on. */
static double next_end(MODEL *m)
{
    double end;
    while (m->steps < STEPS && step_ends[m->steps] <= m->time) m->steps++;
    end = m->steps < STEPS ? step_ends[m->steps] : m->time + LAST_STEP;
#if SAMPLED
    end = instant_before(m->time, end);
#endif
    return end;
}

/* Tries the step up to `m->open`; returns whether its numbers are finite. */
static int step_once(MODEL *m)
{
    double h = m->open - m->time;
    int stage, i;
    for (stage = 1; stage < STAGES - 1; stage++) evaluate_stage(m, stage, h);
    combine(m, STAGES - 1, h, m->next);
    close_motion(m, m->open, m->next);
    rate(m, m->open, m->next, m->rates[STAGES - 1]);
    for (i = 0; i < 2 * N; i++)
        if (!isfinite(m->next[i])) return 0;
    return 1;
}

/* Goes on from the end of the step. */
static void accept(MODEL *m)
{
    keep(m->next, m->state, 2 * N);
    keep(m->rates[STAGES - 1], m->rates[0], 2 * N);
    m->time = m->open;
#if SAMPLED
    if (is_instant(m->time)) {
        double *r = m->closure;
        r[TIME] = m->time;
        keep(m->state, r + Q, 2 * N);
        settle(r, closure_acceleration, W, N + M);
        change_sampled(r, closure_sampling, closure_values);
        keep(r + Q, m->state, 2 * N);
        rate(m, m->time, m->state, m->rates[0]);
    }
#endif
}

static void interpolate(MODEL *m, double time)
{
    double share = (time - m->time) / (m->open - m->time);
    int i, k;
    for (i = 0; i < 2 * N; i++) {
        double value = 0.0;
        for (k = 0; k < 7; k++) value = (value + m->dense[6 - k][i]) * (k % 2 == 0 ? share : 1.0 - share);
        m->motion[i] = m->state[i] + value;
    }
}

/* The motion at a time; a step that passes it stays open. Returns 1 where its numbers are not finite. */
static int reach(MODEL *m, double time)
{
    while (time > m->time || m->open > m->time) {
        if (!(m->open > m->time)) {
            m->open = next_end(m);
            if (!step_once(m)) return 1;
            if (time < m->open) prepare_dense(m);
        }
        if (time < m->open) {
            interpolate(m, time);
            break;
        }
        accept(m);
    }
    if (!(m->open > m->time)) keep(m->state, m->motion, 2 * N);
    m->now = time;
    close_motion(m, time, m->motion);
    return 0;
}

/* From a consistent state with its parameters. */
static void begin_motion(MODEL *m, const double *state)
{
    begin_closure(m, state);
    keep(state + Q, m->state, 2 * N);
    keep(state + Q, m->motion, 2 * N);
    m->time = m->open = m->now = state[TIME];
    m->steps = 0;
    rate(m, m->time, m->state, m->rates[0]);
}

int MODEL_STEP(MODEL *m, double h, double end, int refines)
{
    (void)h;
    (void)refines;
    return reach(m, end);
}

int MODEL_ROW(MODEL *m, int row) { return reach(m, row_times[row]); }

double MODEL_TIME(int row) { return row_times[row]; }

void MODEL_OBSERVE(MODEL *m, double *outputs) { observe_motion(m, m->now, m->motion, outputs); }
