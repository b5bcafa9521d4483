
static void set_step_size(STEPPER *s, double h)
{
    int i;
    if (isfinite(s->step_size) && s->step_size != h)
        for (i = 0; i < N; i++) {
            double w = s->r[W + i];
            s->r[A + i] = w + h / s->step_size * (s->r[A + i] - w);
        }
    s->step_size = h;
    if (s->prepared_size != h) {
        s->r[STEP] = h;
        step_size(s->r);
        s->prepared_size = h;
    }
}

#if CONTROLLED
/* The error of positions in a step that was solved, relative to each coordinate's size: of what moves the mechanism, and of
 * the whole change of acceleration. */
static void measure(STEPPER *s, double h)
{
    double gain = fabs(ERROR_GAIN * h * h);
    int i;
    estimate(s->r);
    s->error = s->whole_error = 0.0;
    for (i = 0; i < N; i++) {
        double whole = OF_NEW * s->r[ITERATE + i] + OF_OLD * s->r[W + i] - (1.0 + OF_ALGORITHMIC) * s->r[A + i];
        double unit = gain / fmax(scale[i], fabs(s->r[Q + i]));
#if SINGULAR
        double error = unit * fabs(s->is_singular ? whole : s->r[CORRECTION + i]);
#else
        double error = unit * fabs(s->r[CORRECTION + i]);
#endif
        /* NaN wins and stays. */
        if (!(error <= s->error || isnan(s->error))) s->error = error;
        if (!(unit * fabs(whole) <= s->whole_error || isnan(s->whole_error))) s->whole_error = unit * fabs(whole);
    }
}
#endif

/* One step without substeps; the state stays where it does not converge. */
static int try_step(STEPPER *s, double h, double end, int refines)
{
    int converged;
    set_step_size(s, h);
    s->r[TIME] = end;
    step(s->r);
    keep(s->r + W, s->now, UNKNOWNS);
    if (h != s->size_before && s->known > 1) s->known = 1;
    predict(s, s->known, h);
    if (s->steps % STEPS_BETWEEN_LOOKS == 0) s->contraction = first_contraction;
    s->steps++;
    converged = iterate(s, h);
#if SINGULAR
    s->is_singular = !converged;
    if (!converged) converged = iterate_singular(s, h);
    refines = refines && !s->is_singular;
#endif
    if (converged && refines) {
        correct(s->r);
        apply(s, GAIN * h * h);
    }
    if (!converged) keep(s->now + N, s->r + LAMBDA, M);
    keep(s->before, s->before_that, UNKNOWNS);
    keep(s->now, s->before, UNKNOWNS);
    s->known = s->known < 2 ? s->known + 1 : 2;
    s->size_before = h;
#if CONTROLLED
    measure(s, h);
#endif
    if (converged) advance(s->r);
    return converged;
}

/* Accelerations and multipliers do not go on from those of the steps before. */
static void forget(STEPPER *s)
{
    s->contraction = first_contraction;
    s->known = 0;
}

static void begin(STEPPER *s)
{
    s->step_size = s->prepared_size = s->size_before = NAN;
    forget(s);
    s->steps = 0;
}

