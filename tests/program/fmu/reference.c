/* Units with the equations of the Reference FMUs of the Modelica Association, written for the tests: a bouncing ball (-DBALL), van der
 * Pol's oscillator (-DVANDERPOL), Dahlquist's equation (-DDAHLQUIST), stairs (-DSTAIR), inputs that are outputs (-DFEEDTHROUGH) and a
 * resource (-DRESOURCE). In co-simulation they take steps of Euler's method. */

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

/* Numbers of variables: parameters, states and what else is set stand first. */
enum { A, B, SETTABLE };

typedef struct {
    double values[SETTABLE], x[2], t;
    int whole, truth, is_at_rest, rebounds;
} unit;

#if defined BALL
enum { STATES = 2 };
static const double starts[] = { -9.81, 0.7 }, step = 1e-3;
#elif defined VANDERPOL
enum { STATES = 2 };
static const double starts[] = { 1.0, 2.0 }, step = 1e-2;
#elif defined DAHLQUIST
enum { STATES = 1 };
static const double starts[] = { 1.0, 1.0 }, step = 0.1;
#else
enum { STATES = 0 };
static const double starts[] = { 0.0, 0.0 }, step = 0.1;
#endif

static unit *make(const char *resources)
{
    unit *own = calloc(1, sizeof *own);
    own->values[A] = starts[A];
    own->values[B] = starts[B];
#if defined RESOURCE
    {
        char path[4096];
        FILE *file;
        snprintf(path, sizeof path, "%s%sy.txt", resources, FMI == 2 ? "/" : "");
        file = fopen(FMI == 2 ? path + 7 : path, "r");
        own->whole = file ? fgetc(file) : -1;
        if (file) fclose(file);
    }
#else
    (void)resources;
#endif
    return own;
}

static void begin(unit *own)
{
#if defined BALL
    own->x[0] = 1.0;
#elif defined VANDERPOL
    own->x[0] = own->values[B];
#elif defined DAHLQUIST
    own->x[0] = own->values[B];
#endif
    (void)own;
}

static double real(const unit *own, unsigned of) { return of < SETTABLE ? own->values[of] : own->x[(of - SETTABLE) % 2]; }

static int set_real(unit *own, unsigned of, double value)
{
    if (of >= SETTABLE) return 3;
    own->values[of] = value;
#if defined FEEDTHROUGH
    own->x[of] = value;
#endif
    return 0;
}

static int whole(const unit *own, unsigned of) { (void)of; return own->whole; }
static int set_whole(unit *own, unsigned of, int value) { (void)of; own->whole = value; return 0; }
static int truth(const unit *own, unsigned of) { (void)of; return own->truth; }
static int set_truth(unit *own, unsigned of, int value) { (void)of; own->truth = value; return 0; }
static double *states(unit *own) { return own->x; }
static int trouble(const unit *own) { (void)own; return 0; }

static void slopes(const unit *own, double *into)
{
#if defined BALL
    into[0] = own->x[1];
    into[1] = own->is_at_rest ? 0.0 : own->values[A];
#elif defined VANDERPOL
    into[0] = own->x[1];
    into[1] = own->values[A] * ((1.0 - own->x[0] * own->x[0]) * own->x[1]) - own->x[0];
#elif defined DAHLQUIST
    into[0] = -own->values[A] * own->x[0];
#endif
    (void)own; (void)into;
}

static double indicator(const unit *own) { return own->is_at_rest ? 1.0 : own->x[0]; }

static double next_event(const unit *own)
{
#if defined STAIR
    return own->whole < 10 ? own->whole + 1.0 : INFINITY;
#else
    (void)own;
    return INFINITY;
#endif
}

static int ends(const unit *own)
{
#if defined STAIR
    return own->whole >= 10;
#else
    (void)own;
    return 0;
#endif
}

/* Whether the event changed the states. */
static int event(unit *own)
{
#if defined BALL
    if (own->x[0] <= 0.0 && own->x[1] < 0.0) {
        own->x[0] = 2.2250738585072014e-308;
        own->x[1] *= -own->values[B];
        if (own->x[1] < 0.1) {
            own->x[1] = 0.0;
            own->is_at_rest = 1;
        }
        return 1;
    }
#elif defined STAIR
    if (own->t >= own->whole + 1.0 - 1e-9) own->whole++;
#endif
    (void)own;
    return 0;
}

static int advance(unit *own, double h)
{
    double end = own->t + h, slope[2] = { 0.0, 0.0 };
    while (own->t + step < end + 1e-6 * step) {
        slopes(own, slope);
        own->x[0] += step * slope[0];
        own->x[1] += step * slope[1];
        own->t += step;
        event(own);
    }
    return 0;
}

#include "wrapper.c"
