
enum { MOST_HALVINGS = 10 };

/* One step of a level; one that does not converge is divided into 2, 4, … */
static int take_step(MODEL *m, int level, double h, double end, int refines)
{
    STEPPER *s = &m->levels[level].shared;
    saved start;
    int halvings;
    if (try_step(s, h, end, refines)) return 1;
    keep(s->r + Q, start.of, 4 * N + M);
    for (halvings = 1; halvings <= MOST_HALVINGS; halvings++) {
        int parts = 1 << halvings, part, done = 1;
        STEPPER alone = *s;
        begin(&alone);
        keep(start.of, alone.r + Q, 4 * N + M);
        alone.step_size = h;
        for (part = 1; part <= parts && done; part++)
            done = try_step(&alone, h / parts, end - (parts - part) * (h / parts), refines);
        if (!done) continue;
        set_step_size(&alone, h);
        keep(alone.r + Q, s->r + Q, 4 * N + M);
        return 1;
    }
    return 0;
}
