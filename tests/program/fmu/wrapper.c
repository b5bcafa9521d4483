/* Functions of FMI 2.0 (-DFMI=2) or 3.0 for a model of the tests, for co-simulation and model exchange. Written by the standard. */

#include <stdbool.h>
#include <stdint.h>
#include <string.h>

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
    return make(resources);
}
void fmi2FreeInstance(void *own) { free(own); }
int fmi2SetupExperiment(void *own, int t, double tolerance, double start, int ends, double end)
{ (void)own; (void)t; (void)tolerance; (void)ends; (void)end; return start == 0.0 ? 0 : 3; }
int fmi2EnterInitializationMode(void *own) { begin(own); return 0; }
int fmi2ExitInitializationMode(void *own) { (void)own; return 0; }
int fmi2GetReal(void *own, const unsigned *of, size_t n, double *v) { for (size_t i = 0; i < n; i++) v[i] = real(own, of[i]); return 0; }
int fmi2SetReal(void *own, const unsigned *of, size_t n, const double *v) { for (size_t i = 0; i < n; i++) if (set_real(own, of[i], v[i])) return 3; return 0; }
int fmi2GetInteger(void *own, const unsigned *of, size_t n, int *v) { for (size_t i = 0; i < n; i++) v[i] = whole(own, of[i]); return 0; }
int fmi2SetInteger(void *own, const unsigned *of, size_t n, const int *v) { return n == 1 ? set_whole(own, of[0], v[0]) : 3; }
int fmi2GetBoolean(void *own, const unsigned *of, size_t n, int *v) { for (size_t i = 0; i < n; i++) v[i] = truth(own, of[i]); return 0; }
int fmi2SetBoolean(void *own, const unsigned *of, size_t n, const int *v) { return n == 1 ? set_truth(own, of[0], v[0]) : 3; }
int fmi2DoStep(void *own, double t, double h, int keeps)
{
    int status = fabs(t - ((unit *)own)->t) > 1e-9 ? 3 : advance(own, h);
    (void)keeps;
    return status == 0 && ends(own) ? 2 : status;
}
int fmi2GetRealStatus(void *own, int kind, double *value) { *value = ((unit *)own)->t; return kind == 2 ? 0 : 3; }
int fmi2GetBooleanStatus(void *own, int kind, int *value) { *value = ends(own); return kind == 3 ? 0 : 3; }
int fmi2EnterEventMode(void *own) { (void)own; return 0; }
int fmi2NewDiscreteStates(void *own, event_info *info)
{
    info->again = info->nominals = 0;
    info->states = event(own);
    info->ends = ends(own);
    info->next = next_event(own);
    info->known = info->next < INFINITY;
    return 0;
}
int fmi2EnterContinuousTimeMode(void *own) { (void)own; return 0; }
int fmi2CompletedIntegratorStep(void *own, int keeps, int *events, int *ends) { (void)keeps; *events = *ends = 0; return trouble(own); }
int fmi2SetTime(void *own, double t) { ((unit *)own)->t = t; return 0; }
int fmi2SetContinuousStates(void *own, const double *v, size_t n) { memcpy(states(own), v, n * sizeof *v); return n == STATES ? 0 : 3; }
int fmi2GetContinuousStates(void *own, double *v, size_t n) { memcpy(v, states(own), n * sizeof *v); return n == STATES ? 0 : 3; }
int fmi2GetDerivatives(void *own, double *v, size_t n) { slopes(own, v); return n == STATES ? 0 : 3; }
int fmi2GetEventIndicators(void *own, double *v, size_t n) { if (n) v[0] = indicator(own); return 0; }

#else

typedef void (*logger)(void *, int, const char *, const char *);

void *fmi3InstantiateCoSimulation(const char *name, const char *token, const char *resources, bool visible, bool logging, bool events, bool early,
                                  const uint32_t *required, size_t count, void *environment, logger log, void (*update)(void))
{
    (void)name; (void)visible; (void)logging; (void)events; (void)early; (void)required; (void)count; (void)update;
    if (token[0] != '{') return NULL;
    log(environment, 1, "hello", "unit says hello");
    return make(resources);
}
void *fmi3InstantiateModelExchange(const char *name, const char *token, const char *resources, bool visible, bool logging, void *environment, logger log)
{ (void)name; (void)visible; (void)logging; (void)environment; (void)log; return token[0] == '{' ? make(resources) : NULL; }
void fmi3FreeInstance(void *own) { free(own); }
int fmi3EnterInitializationMode(void *own, bool t, double tolerance, double start, bool ends, double end)
{ (void)t; (void)tolerance; (void)ends; (void)end; begin(own); return start == 0.0 ? 0 : 3; }
int fmi3ExitInitializationMode(void *own) { (void)own; return 0; }
int fmi3GetFloat64(void *own, const uint32_t *of, size_t n, double *v, size_t m) { (void)m; for (size_t i = 0; i < n; i++) v[i] = real(own, of[i]); return 0; }
int fmi3SetFloat64(void *own, const uint32_t *of, size_t n, const double *v, size_t m) { (void)m; for (size_t i = 0; i < n; i++) if (set_real(own, of[i], v[i])) return 3; return 0; }
int fmi3GetFloat32(void *own, const uint32_t *of, size_t n, float *v, size_t m) { (void)own; (void)of; (void)n; (void)m; *v = 0.5f; return 0; }
int fmi3SetFloat32(void *own, const uint32_t *of, size_t n, const float *v, size_t m) { (void)own; (void)of; (void)n; (void)v; (void)m; return 3; }
#define WHOLE(name, type) \
    int fmi3Get##name(void *own, const uint32_t *of, size_t n, type *v, size_t m) { (void)m; for (size_t i = 0; i < n; i++) v[i] = whole(own, of[i]); return 0; } \
    int fmi3Set##name(void *own, const uint32_t *of, size_t n, const type *v, size_t m) { (void)m; return n == 1 ? set_whole(own, of[0], v[0]) : 3; }
WHOLE(Int8, int8_t)
WHOLE(UInt8, uint8_t)
WHOLE(Int16, int16_t)
WHOLE(UInt16, uint16_t)
WHOLE(Int32, int32_t)
WHOLE(UInt32, uint32_t)
WHOLE(Int64, int64_t)
WHOLE(UInt64, uint64_t)
int fmi3GetBoolean(void *own, const uint32_t *of, size_t n, bool *v, size_t m) { (void)m; for (size_t i = 0; i < n; i++) v[i] = truth(own, of[i]); return 0; }
int fmi3SetBoolean(void *own, const uint32_t *of, size_t n, const bool *v, size_t m) { (void)m; return n == 1 ? set_truth(own, of[0], v[0]) : 3; }
int fmi3DoStep(void *own, double t, double h, bool keeps, bool *events, bool *terminates, bool *early, double *reached)
{
    int status = fabs(t - ((unit *)own)->t) > 1e-9 ? 3 : advance(own, h);
    (void)keeps;
    *events = *early = false;
    *terminates = ends(own);
    *reached = t + h;
    return status;
}
int fmi3EnterEventMode(void *own) { (void)own; return 0; }
int fmi3UpdateDiscreteStates(void *own, bool *again, bool *terminates, bool *nominals, bool *states, bool *known, double *next)
{
    *again = *nominals = false;
    *states = event(own);
    *terminates = ends(own);
    *next = next_event(own);
    *known = *next < INFINITY;
    return 0;
}
int fmi3EnterContinuousTimeMode(void *own) { (void)own; return 0; }
int fmi3CompletedIntegratorStep(void *own, bool keeps, bool *events, bool *ends) { (void)keeps; *events = *ends = false; return trouble(own); }
int fmi3SetTime(void *own, double t) { ((unit *)own)->t = t; return 0; }
int fmi3SetContinuousStates(void *own, const double *v, size_t n) { memcpy(states(own), v, n * sizeof *v); return n == STATES ? 0 : 3; }
int fmi3GetContinuousStates(void *own, double *v, size_t n) { memcpy(v, states(own), n * sizeof *v); return n == STATES ? 0 : 3; }
int fmi3GetContinuousStateDerivatives(void *own, double *v, size_t n) { slopes(own, v); return n == STATES ? 0 : 3; }
int fmi3GetNumberOfEventIndicators(void *own, size_t *n) { (void)own; *n = INDICATORS; return 0; }
int fmi3GetEventIndicators(void *own, double *v, size_t n) { if (n) v[0] = indicator(own); return 0; }

#endif
