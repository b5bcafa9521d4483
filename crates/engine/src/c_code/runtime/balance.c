
/* Equilibrium at rest with other parameters: Newton's method from the nominal one, on positions and multipliers at once. */

enum { BALANCED = N + M };

/* Solves the equations, whose right side is the last column; returns whether there is a solution. */
static int eliminate(double *a)
{
    const int width = BALANCED + 1;
    int i, j, k;
    for (k = 0; k < BALANCED; k++) {
        int pivot = k;
        for (i = k + 1; i < BALANCED; i++)
            if (fabs(a[i * width + k]) > fabs(a[pivot * width + k])) pivot = i;
        if (!(fabs(a[pivot * width + k]) > 0.0)) return 0;
        for (j = k; j < width; j++) {
            double value = a[pivot * width + j];
            a[pivot * width + j] = a[k * width + j];
            a[k * width + j] = value;
        }
        for (i = k + 1; i < BALANCED; i++) {
            double ratio = a[i * width + k] / a[k * width + k];
            for (j = k; j < width && ratio != 0.0; j++) a[i * width + j] -= ratio * a[k * width + j];
        }
    }
    for (k = BALANCED - 1; k >= 0; k--) {
        for (j = k + 1; j < BALANCED; j++) a[k * width + BALANCED] -= a[k * width + j] * a[j * width + BALANCED];
        a[k * width + BALANCED] /= a[k * width + k];
    }
    return 1;
}

/* Corrections until they settle; returns whether they do. Everything is per scale of the coordinates. */
static int balance(MODEL *m)
{
    const int width = BALANCED + 1;
    double *r = m->balance, *a = m->matrix, last = NAN;
    int count, i;
    for (count = 0; count < 40; count++) {
        double size = 0.0;
        balance_residual(r);
        balance_jacobian(r);
        for (i = 0; i < BALANCED * width; i++) a[i] = 0.0;
        for (i = 0; i < BALANCE_ENTRIES; i++) {
            int row = balance_entries[i].row, column = balance_entries[i].column;
            a[row * width + column] += r[balance_entries[i].at] * (row < N ? scale[row] : 1.0) * (column < N ? scale[column] : 1.0);
        }
        for (i = 0; i < BALANCED; i++) a[i * width + BALANCED] = -r[balance_rows[i]] * (i < N ? scale[i] : 1.0);
        /* Constraints that others imply have no multipliers. */
        for (i = 0; i < REDUNDANT; i++) {
            int row = N + redundant[i] - LAMBDA;
            a[row * width + row] = 1.0;
            a[row * width + BALANCED] = 0.0;
        }
        if (!eliminate(a)) return 0;
        for (i = 0; i < BALANCED; i++) {
            double change = a[i * width + BALANCED], relative;
            r[i < N ? Q + i : LAMBDA + i - N] += (i < N ? scale[i] : 1.0) * change;
            relative = i < N ? fabs(change) / fmax(1.0, fabs(r[Q + i] / scale[i])) : 0.0;
            if (!(relative <= size)) size = relative;
        }
        if (!isfinite(size)) return 0;
        if (size <= 1e-14 || (size <= 1e-9 && size >= 0.5 * last)) return 1;
        last = size;
    }
    return 0;
}

/* The equilibrium of other parameters by so many changes of them; returns whether there is one. */
static int balance_at(MODEL *m, const double *parameters, int parts)
{
    double *r = m->balance;
    int part, i;
    for (i = 0; i < BALANCE_CONSTANTS; i++) r[balance_constants[i].at] = balance_constants[i].value;
    keep(start_values, r, LAYOUT);
    for (i = 0; i < 3 * N; i++) r[V + i] = 0.0;
    for (i = 0; i < BALANCE_STATES; i++) r[balance_states[i].position] = start_values[balance_states[i].value];
    for (part = 1; part <= parts; part++) {
        set_parameters(r, parameters, part, parts);
        balance_sample(r);
        if (!balance(m)) return 0;
    }
    return 1;
}
