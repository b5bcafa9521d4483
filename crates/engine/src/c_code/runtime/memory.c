/* Copies of parts of a memory, and a whole state: q, v, a, w, λ. */
static void keep(const double *from, double *into, int count) { memcpy(into, from, (size_t)count * sizeof *into); }

typedef struct { double of[4 * N + M + 1]; } saved;
