/* Copies of parts of a memory, and a whole state: q, v, a, w, λ. */
static void keep(const double *from, double *into, int count) { memcpy(into, from, (size_t)count * sizeof *into); }

typedef struct { double of[4 * N + M + 1]; } saved;

#if PARAMETERS
/* Parameters on the way from the nominal ones to others: a part of so many. */
static void set_parameters(double *r, const double *parameters, int part, int parts)
{
    int i;
    for (i = 0; i < PARAMETERS; i++) {
        double nominal = parameter_values[i];
        r[PARAMETER + i] = part == parts ? parameters[i] : nominal + (double)part / parts * (parameters[i] - nominal);
    }
}
#endif
