/* A unit of FMI 2.0 (-DFMI=2) or 3.0, for co-simulation and model exchange: a mass on a spring, x = x0 cos(sqrt(k/m) t),
 * or with -DBALL a ball that falls from x0 by g = k and rebounds with v = -m v. Written for the tests, by the standard. */

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

enum { STATES = 2 };

enum { K, M, X0, MODE, X, V, TEMPERATURE, COUNT, NOISE };

typedef struct {
    double k, m, x0, x, v, t;
    int mode, count;
    void (*log)(void);
    void *environment;
} unit;

static unit *make(const char *resources)
{
    unit *own = calloc(1, sizeof *own);
    (void)resources;
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

static double *states(unit *own) { return &own->x; }
static double indicator(const unit *own) { return own->x; }
static double next_event(const unit *own) { (void)own; return INFINITY; }
static int ends(const unit *own) { (void)own; return 0; }
static int whole(const unit *own, unsigned of) { (void)of; return own->count; }
static int truth(const unit *own, unsigned of) { (void)own; (void)of; return 1; }
static int set_truth(unit *own, unsigned of, int value) { (void)own; (void)of; (void)value; return 3; }

static int set_whole(unit *own, unsigned of, int value)
{
    (void)of;
    own->mode = value;
    return 0;
}

#include "wrapper.c"
