/* A unit of FMI for co-simulation, of a model that was written by mbint: parts that the versions share. */

#include <math.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#if defined _WIN32
#define EXPORT __declspec(dllexport)
#else
#define EXPORT __attribute__((visibility("default")))
#endif

enum { OK = 0, ERROR = 3 };

/* An instance: the motion, the time that it has come to, the model's row there or -1, its parameters, and how the host hears of
 * failures. */
typedef struct {
    MODEL_TYPE model;
    double time, parameters[MODEL_PARAMETER_COUNT + 1];
    int row;
    bool is_started, runs;
    void *environment;
    LOG log;
} instance;

static void begin(instance *own)
{
    own->time = 0.0;
    own->row = 0;
    own->is_started = own->runs = false;
#if MODEL_PARAMETER_COUNT
    memcpy(own->parameters, MODEL_PARAMETER_VALUES, MODEL_PARAMETER_COUNT * sizeof *own->parameters);
#endif
}

/* The start of the parameters, where they are new; returns why there is none. */
static const char *start(instance *own)
{
    if (own->is_started) return NULL;
#if MODEL_PARAMETER_COUNT
    if (MODEL_START_AT(&own->model, own->parameters)) return "the mechanism cannot be assembled with these parameters";
#else
    MODEL_START(&own->model);
#endif
    own->is_started = true;
    return NULL;
}

static const char *run_from_start(instance *own)
{
    own->runs = true;
    return start(own);
}

/* Whether two times are one but for rounding. */
static bool are_same(double a, double b) { return fabs(a - b) <= 1e-9 * (1.0 + fabs(a)); }

/* A communication step: from row to row by the steps of a run, else in steps of the model's length or a little shorter; returns
 * why it fails. */
static const char *move_on(instance *own, double now, double size)
{
    double count = ceil(size / MODEL_H - 1e-9), h, k;
    if (!are_same(now, own->time)) return "a step begins where the last one ended";
    own->time = now + size;
    if (own->row >= 0 && own->row + 1 < MODEL_ROWS && are_same(MODEL_TIME(own->row + 1), own->time))
        return MODEL_ROW(&own->model, ++own->row) ? "a step does not converge" : NULL;
    own->row = -1;
    h = size / count;
    /* The model's own step, to the last bit: another length would make factors anew. */
    if (fabs(h - MODEL_H) <= 1e-12 * MODEL_H) h = MODEL_H;
    for (k = 1.0; k <= count; k += 1.0)
        if (MODEL_STEP(&own->model, h, k < count ? now + k * h : own->time, k == count)) return "a step does not converge";
    return NULL;
}

/* Values of variables: the time is number 0, then come outputs, then parameters. */
static const char *read_values(instance *own, const uint32_t references[], size_t count, double values[])
{
    double outputs[MODEL_OUTPUT_COUNT + 1];
    const char *failure = start(own);
    size_t k;
    if (failure) return failure;
    MODEL_OUTPUTS(&own->model, outputs);
    for (k = 0; k < count; k++) {
        uint32_t of = references[k];
        if (of > MODEL_OUTPUT_COUNT + MODEL_PARAMETER_COUNT) return "there is no such variable";
        values[k] = of == 0 ? own->time : of <= MODEL_OUTPUT_COUNT ? outputs[of - 1] : own->parameters[of - MODEL_OUTPUT_COUNT - 1];
    }
    return NULL;
}

static const char *write_values(instance *own, const uint32_t references[], size_t count, const double values[])
{
    size_t k;
    for (k = 0; k < count; k++) {
        uint32_t of = references[k];
        if (of <= MODEL_OUTPUT_COUNT || of > MODEL_OUTPUT_COUNT + MODEL_PARAMETER_COUNT) return "this variable cannot be set";
#if MODEL_PARAMETER_COUNT
        of -= MODEL_OUTPUT_COUNT + 1;
        if (own->runs && !is_input[of]) return "a parameter is set before the motion";
        own->parameters[of] = values[k];
        if (own->runs) MODEL_SET(&own->model, (int)of, values[k]);
        else own->is_started = false;
#endif
    }
    (void)own; (void)values;
    return NULL;
}

/* A state that is kept is an instance, too. */
static int keep_state(const instance *own, void **state)
{
    if (!*state) *state = malloc(sizeof *own);
    if (!*state) return ERROR;
    memcpy(*state, own, sizeof *own);
    return OK;
}

static int restore_state(instance *own, const void *state)
{
    instance kept = *own;
    memcpy(own, state, sizeof *own);
    own->environment = kept.environment;
    own->log = kept.log;
    return OK;
}

static int write_state(const void *state, void *bytes, size_t size)
{
    if (size < sizeof(instance)) return ERROR;
    memcpy(bytes, state, sizeof(instance));
    return OK;
}

static int read_state(const void *bytes, size_t size, void **state)
{
    return size < sizeof(instance) ? ERROR : keep_state(bytes, state);
}
