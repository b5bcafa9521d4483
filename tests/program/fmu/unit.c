/* A unit of FMI 2.0 (-DFMI=2) or 3.0, for co-simulation and model exchange: a mass on a spring, x = x0 cos(sqrt(k/m) t),
 * or with -DBALL a ball that falls from x0 by g = k and rebounds with v = -m v. Written for the tests, by the standard. */

#include <math.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

enum { K, M, X0, MODE, X, V, TEMPERATURE, COUNT, NOISE };

typedef struct {
    double k, m, x0, x, v, t;
    int mode, count;
    void (*log)(void);
    void *environment;
} unit;

static unit *make(void)
{
    unit *own = calloc(1, sizeof *own);
    own->k = START_K;
    own->m = START_M;
    own->x0 = 100.0;
    return own;
}

static double real(const unit *own, unsigned of)
{
    switch (of) {
    case K: return own->k;
    case M: return own->m;
    case X0: return own->x0;
    case X: return 1000.0 * own->x;
    case V: return own->v;
    case TEMPERATURE: return 20.0 + own->x;
    default: return own->mode == 4 && own->k > 205 ? NAN : 0.0;
    }
}

static int set_real(unit *own, unsigned of, double value)
{
    if (of > X0) return 3;
    *(of == K ? &own->k : of == M ? &own->m : &own->x0) = value;
    return 0;
}

static void begin(unit *own)
{
    own->x = 1e-3 * own->x0;
    printf("a unit says hello without an end of line");
    fflush(stdout);
}

/* What goes wrong, above 205 N/m. */
static int trouble(const unit *own)
{
    if (own->k <= 205) return 0;
    if (own->mode == 1) abort();
    if (own->mode == 2) sleep(60);
    return own->mode == 3 ? 3 : 0;
}

static int advance(unit *own, double h)
{
    double w = sqrt(own->k / own->m), x = own->x, v = own->v;
    own->x = x * cos(w * h) + v / w * sin(w * h);
    own->v = v * cos(w * h) - w * x * sin(w * h);
    own->t += h;
    return trouble(own);
}

static void slopes(const unit *own, double *into)
{
    into[0] = own->v;
#ifdef BALL
    into[1] = -own->k;
#else
    into[1] = -own->k / own->m * own->x;
#endif
}

/* Whether the event changed the states. */
static int event(unit *own)
{
#ifdef BALL
    if (own->x <= 0.0 && own->v < 0.0) {
        own->v *= -own->m;
        own->x = 0.0;
        own->count++;
        return 1;
    }
#endif
    (void)own;
    return 0;
}

#if FMI == 2

typedef struct {
    void (*log)(void *, const char *, int, const char *, const char *, ...);
    void *(*allocate)(size_t, size_t);
    void (*free)(void *);
    void (*finished)(void *, int);
    void *environment;
} callbacks;

typedef struct { int again, ends, nominals, states, known; double next; } event_info;

void *fmi2Instantiate(const char *name, int kind, const char *guid, const char *resources, const callbacks *by, int visible, int logging)
{
    (void)kind; (void)visible; (void)logging;
    if (guid[0] != '{' || resources[0] != 'f') return NULL;
    by->log(by->environment, name, 1, "hello", "%s says hello to %d", "unit", 7);
    by->free(by->allocate(3, 8));
    return make();
}
void fmi2FreeInstance(void *own) { free(own); }
int fmi2SetupExperiment(void *own, int t, double tolerance, double start, int ends, double end)
{ (void)own; (void)t; (void)tolerance; (void)ends; (void)end; return start == 0.0 ? 0 : 3; }
int fmi2EnterInitializationMode(void *own) { begin(own); return 0; }
int fmi2ExitInitializationMode(void *own) { (void)own; return 0; }
int fmi2GetReal(void *own, const unsigned *of, size_t n, double *v) { for (size_t i = 0; i < n; i++) v[i] = real(own, of[i]); return 0; }
int fmi2SetReal(void *own, const unsigned *of, size_t n, const double *v) { for (size_t i = 0; i < n; i++) if (set_real(own, of[i], v[i])) return 3; return 0; }
int fmi2GetInteger(void *own, const unsigned *of, size_t n, int *v) { (void)of; (void)n; *v = ((unit *)own)->count; return 0; }
int fmi2SetInteger(void *own, const unsigned *of, size_t n, const int *v) { (void)of; (void)n; ((unit *)own)->mode = *v; return 0; }
int fmi2GetBoolean(void *own, const unsigned *of, size_t n, int *v) { (void)own; (void)of; (void)n; *v = 1; return 0; }
int fmi2SetBoolean(void *own, const unsigned *of, size_t n, const int *v) { (void)own; (void)of; (void)n; (void)v; return 3; }
int fmi2DoStep(void *own, double t, double h, int keeps) { (void)keeps; return fabs(t - ((unit *)own)->t) > 1e-9 ? 3 : advance(own, h); }
int fmi2EnterEventMode(void *own) { (void)own; return 0; }
int fmi2NewDiscreteStates(void *own, event_info *info)
{
    info->again = info->ends = info->nominals = info->known = 0;
    info->states = event(own);
    return 0;
}
int fmi2EnterContinuousTimeMode(void *own) { (void)own; return 0; }
int fmi2CompletedIntegratorStep(void *own, int keeps, int *events, int *ends) { (void)keeps; *events = *ends = 0; return trouble(own); }
int fmi2SetTime(void *own, double t) { ((unit *)own)->t = t; return 0; }
int fmi2SetContinuousStates(void *of, const double *v, size_t n) { unit *own = of; own->x = v[0]; own->v = v[1]; return n == 2 ? 0 : 3; }
int fmi2GetContinuousStates(void *of, double *v, size_t n) { unit *own = of; v[0] = own->x; v[1] = own->v; return n == 2 ? 0 : 3; }
int fmi2GetDerivatives(void *own, double *v, size_t n) { slopes(own, v); return n == 2 ? 0 : 3; }
int fmi2GetEventIndicators(void *own, double *v, size_t n) { if (n) v[0] = ((unit *)own)->x; return 0; }

#else

typedef void (*logger)(void *, int, const char *, const char *);

void *fmi3InstantiateCoSimulation(const char *name, const char *token, const char *resources, bool visible, bool logging, bool events, bool early,
                                  const uint32_t *required, size_t count, void *environment, logger log, void (*update)(void))
{
    (void)name; (void)resources; (void)visible; (void)logging; (void)events; (void)early; (void)required; (void)count; (void)update;
    if (token[0] != '{') return NULL;
    log(environment, 1, "hello", "unit says hello");
    return make();
}
void *fmi3InstantiateModelExchange(const char *name, const char *token, const char *resources, bool visible, bool logging, void *environment, logger log)
{ (void)name; (void)resources; (void)visible; (void)logging; (void)environment; (void)log; return token[0] == '{' ? make() : NULL; }
void fmi3FreeInstance(void *own) { free(own); }
int fmi3EnterInitializationMode(void *own, bool t, double tolerance, double start, bool ends, double end)
{ (void)t; (void)tolerance; (void)ends; (void)end; begin(own); return start == 0.0 ? 0 : 3; }
int fmi3ExitInitializationMode(void *own) { (void)own; return 0; }
int fmi3GetFloat64(void *own, const uint32_t *of, size_t n, double *v, size_t m) { (void)m; for (size_t i = 0; i < n; i++) v[i] = real(own, of[i]); return 0; }
int fmi3SetFloat64(void *own, const uint32_t *of, size_t n, const double *v, size_t m) { (void)m; for (size_t i = 0; i < n; i++) if (set_real(own, of[i], v[i])) return 3; return 0; }
int fmi3GetFloat32(void *own, const uint32_t *of, size_t n, float *v, size_t m) { (void)own; (void)of; (void)n; (void)m; *v = 0.5f; return 0; }
int fmi3SetFloat32(void *own, const uint32_t *of, size_t n, const float *v, size_t m) { (void)own; (void)of; (void)n; (void)v; (void)m; return 3; }
int fmi3GetInt32(void *own, const uint32_t *of, size_t n, int32_t *v, size_t m) { (void)of; (void)n; (void)m; *v = ((unit *)own)->count; return 0; }
int fmi3SetInt32(void *own, const uint32_t *of, size_t n, const int32_t *v, size_t m) { (void)of; (void)n; (void)m; ((unit *)own)->mode = *v; return 0; }
int fmi3GetBoolean(void *own, const uint32_t *of, size_t n, bool *v, size_t m) { (void)own; (void)of; (void)n; (void)m; *v = true; return 0; }
int fmi3SetBoolean(void *own, const uint32_t *of, size_t n, const bool *v, size_t m) { (void)own; (void)of; (void)n; (void)v; (void)m; return 3; }
int fmi3DoStep(void *own, double t, double h, bool keeps, bool *events, bool *ends, bool *early, double *reached)
{ (void)keeps; *events = *ends = *early = false; *reached = t + h; return fabs(t - ((unit *)own)->t) > 1e-9 ? 3 : advance(own, h); }
int fmi3EnterEventMode(void *own) { (void)own; return 0; }
int fmi3UpdateDiscreteStates(void *own, bool *again, bool *ends, bool *nominals, bool *states, bool *known, double *next)
{ *again = *ends = *nominals = *known = false; *next = 0.0; *states = event(own); return 0; }
int fmi3EnterContinuousTimeMode(void *own) { (void)own; return 0; }
int fmi3CompletedIntegratorStep(void *own, bool keeps, bool *events, bool *ends) { (void)keeps; *events = *ends = false; return trouble(own); }
int fmi3SetTime(void *own, double t) { ((unit *)own)->t = t; return 0; }
int fmi3SetContinuousStates(void *of, const double *v, size_t n) { unit *own = of; own->x = v[0]; own->v = v[1]; return n == 2 ? 0 : 3; }
int fmi3GetContinuousStates(void *of, double *v, size_t n) { unit *own = of; v[0] = own->x; v[1] = own->v; return n == 2 ? 0 : 3; }
int fmi3GetContinuousStateDerivatives(void *own, double *v, size_t n) { slopes(own, v); return n == 2 ? 0 : 3; }
int fmi3GetNumberOfEventIndicators(void *own, size_t *n) { (void)own; *n = INDICATORS; return 0; }
int fmi3GetEventIndicators(void *own, double *v, size_t n) { if (n) v[0] = ((unit *)own)->x; return 0; }

#endif
