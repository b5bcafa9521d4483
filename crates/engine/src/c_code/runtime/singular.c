
/* Newton's iteration where the matrix may have lost rank: each correction is the shortest with the least residual, by singular values
 * (one-sided rotations of Jacobi). Accelerations do not depend on that choice, and multipliers are undetermined there. */

enum { MOST_SWEEPS = 60 };

/* The shortest x with the least |a x - b|; a is lost. */
static void solve_shortest(double *a, const double *b, double *x)
{
    double v[UNKNOWNS * UNKNOWNS], largest = 0.0;
    int i, p, q, sweep, rotates = 1;
    for (i = 0; i < UNKNOWNS * UNKNOWNS; i++) v[i] = i % (UNKNOWNS + 1) == 0 ? 1.0 : 0.0;
    for (sweep = 0; sweep < MOST_SWEEPS && rotates; sweep++) {
        rotates = 0;
        for (p = 0; p < UNKNOWNS; p++)
            for (q = p + 1; q < UNKNOWNS; q++) {
                double alpha = 0.0, beta = 0.0, gamma = 0.0, zeta, t, c, s;
                for (i = 0; i < UNKNOWNS; i++) {
                    double ap = a[i * UNKNOWNS + p], aq = a[i * UNKNOWNS + q];
                    alpha += ap * ap;
                    beta += aq * aq;
                    gamma += ap * aq;
                }
                if (!(fabs(gamma) > 1e-16 * sqrt(alpha * beta)) || gamma == 0.0) continue;
                rotates = 1;
                zeta = (beta - alpha) / (2.0 * gamma);
                t = (zeta >= 0.0 ? 1.0 : -1.0) / (fabs(zeta) + sqrt(1.0 + zeta * zeta));
                c = 1.0 / sqrt(1.0 + t * t);
                s = c * t;
                for (i = 0; i < UNKNOWNS; i++) {
                    double *rows[2];
                    int k;
                    rows[0] = a + i * UNKNOWNS;
                    rows[1] = v + i * UNKNOWNS;
                    for (k = 0; k < 2; k++) {
                        double first = rows[k][p], second = rows[k][q];
                        rows[k][p] = c * first - s * second;
                        rows[k][q] = s * first + c * second;
                    }
                }
            }
    }
    for (p = 0; p < UNKNOWNS; p++) {
        double size = 0.0;
        for (i = 0; i < UNKNOWNS; i++) size += a[i * UNKNOWNS + p] * a[i * UNKNOWNS + p];
        largest = fmax(largest, sqrt(size));
        x[p] = 0.0;
    }
    for (p = 0; p < UNKNOWNS; p++) {
        double size = 0.0, along = 0.0;
        for (i = 0; i < UNKNOWNS; i++) {
            size += a[i * UNKNOWNS + p] * a[i * UNKNOWNS + p];
            along += a[i * UNKNOWNS + p] * b[i];
        }
        if (sqrt(size) <= 1e-9 * largest) continue;
        for (i = 0; i < UNKNOWNS; i++) x[i] += v[i * UNKNOWNS + p] * (along / size);
    }
}

/* A correction. Constraints that hold to rounding are not corrected any more after the first corrections: each would move the
 * mechanism by rounding over the distance to the singular position. */
static void correct_singular(double *r, double gain, int count)
{
    double a[UNKNOWNS * UNKNOWNS], b[UNKNOWNS], x[UNKNOWNS], rounding[UNKNOWNS];
    int i;
    matrix(r);
    for (i = 0; i < UNKNOWNS * UNKNOWNS; i++) a[i] = 0.0;
    for (i = 0; i < UNKNOWNS; i++) rounding[i] = i < N ? 0.0 : constraint_rounding[i - N] / gain;
    for (i = 0; i < MATRIX_ENTRIES; i++) {
        int row = matrix_entries[i].row, column = matrix_entries[i].column;
        double slope = r[matrix_entries[i].at];
        a[row * UNKNOWNS + column] = equilibration[row] * slope * equilibration[column];
        if (row >= N && column < N) rounding[row] += round_off * fabs(slope) * (fabs(r[Q + column]) + scale[column]) / gain;
    }
    for (i = 0; i < UNKNOWNS; i++) {
        double residual = r[matrix_residuals[i]];
        b[i] = count >= FROZEN_CORRECTIONS && fabs(residual) <= rounding[i] ? 0.0 : -residual * equilibration[i];
    }
    solve_shortest(a, b, x);
    for (i = 0; i < UNKNOWNS; i++) r[CORRECTION + i] = x[i] * equilibration[i];
}

/* Returns whether it converges and the constraints hold: least squares also settle where they cannot. */
static int iterate_singular(STEPPER *s, double h)
{
    double gain = GAIN * h * h, last = 0.0;
    int count, i;
    predict(s, 0, h);
    for (count = 0; count < MOST_CORRECTIONS; count++) {
        double norm, contraction, error;
        correct_singular(s->r, gain, count);
        norm = apply(s, gain);
        contraction = count == 0 ? s->contraction : norm / last;
        if (count == 1) s->contraction = fmax(contraction_safety * contraction, least_contraction);
        error = contraction < 1.0 ? norm * contraction / (1.0 - contraction) : INFINITY;
        last = norm;
        if (!(error <= (count == 0 ? first_tolerance : tolerance) || norm <= round_off)) continue;
        matrix(s->r);
        for (i = N; i < UNKNOWNS; i++)
            if (!(fabs(gain * s->r[matrix_residuals[i]]) <= CLOSED)) return 0;
        return 1;
    }
    return 0;
}
