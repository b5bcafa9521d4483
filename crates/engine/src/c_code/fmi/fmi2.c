
/* FMI 2.0 */

typedef void *fmi2Component;
typedef unsigned int fmi2ValueReference;
typedef const char *fmi2String;
typedef struct {
    LOG log;
    void *(*allocate)(size_t, size_t);
    void (*free)(void *);
    void (*finished)(void *, int);
    void *environment;
} fmi2CallbackFunctions;

static int checked(const instance *own, const char *message)
{
    if (message && own->log) own->log(own->environment, "unit", ERROR, "error", message);
    return message ? ERROR : OK;
}

EXPORT const char *fmi2GetTypesPlatform(void) { return "default"; }
EXPORT const char *fmi2GetVersion(void) { return "2.0"; }

EXPORT int fmi2SetDebugLogging(fmi2Component own, int on, size_t count, const fmi2String categories[])
{
    (void)own; (void)on; (void)count; (void)categories;
    return OK;
}

EXPORT fmi2Component fmi2Instantiate(fmi2String name, int kind, fmi2String guid, fmi2String resources, const fmi2CallbackFunctions *callbacks,
                                     int visible, int logging)
{
    instance *own;
    (void)name; (void)resources; (void)visible; (void)logging;
    if (kind != 1 || !guid || strcmp(guid, TOKEN) != 0) {
        if (callbacks && callbacks->log) callbacks->log(callbacks->environment, "unit", ERROR, "error", "the identifier is that of another model");
        return NULL;
    }
    own = malloc(sizeof *own);
    if (!own) return NULL;
    own->environment = callbacks ? callbacks->environment : NULL;
    own->log = callbacks ? callbacks->log : NULL;
    begin(own);
    return own;
}

EXPORT void fmi2FreeInstance(fmi2Component own) { free(own); }

EXPORT int fmi2SetupExperiment(fmi2Component own, int tolerant, double tolerance, double start, int stops, double stop)
{
    (void)tolerant; (void)tolerance; (void)stops; (void)stop;
    return checked(own, start == 0.0 ? NULL : "the motion begins at t = 0");
}

EXPORT int fmi2EnterInitializationMode(fmi2Component own) { (void)own; return OK; }
EXPORT int fmi2ExitInitializationMode(fmi2Component own) { return checked(own, run_from_start(own)); }
EXPORT int fmi2Terminate(fmi2Component own) { (void)own; return OK; }
EXPORT int fmi2Reset(fmi2Component own) { begin(own); return OK; }

EXPORT int fmi2DoStep(fmi2Component own, double now, double size, int forward)
{
    (void)forward;
    return checked(own, move_on(own, now, size));
}

EXPORT int fmi2CancelStep(fmi2Component own) { (void)own; return ERROR; }

EXPORT int fmi2GetReal(fmi2Component own, const fmi2ValueReference references[], size_t count, double values[])
{
    return checked(own, read_values(own, references, count, values));
}

EXPORT int fmi2SetReal(fmi2Component own, const fmi2ValueReference references[], size_t count, const double values[])
{
    return checked(own, write_values(own, references, count, values));
}

/* Variables of other types there are none. */
#define NO_VALUES(type, c) \
    EXPORT int fmi2Get##type(fmi2Component o, const fmi2ValueReference r[], size_t n, c v[]) { (void)o; (void)r; (void)v; return n == 0 ? OK : ERROR; } \
    EXPORT int fmi2Set##type(fmi2Component o, const fmi2ValueReference r[], size_t n, const c v[]) { (void)o; (void)r; (void)v; return n == 0 ? OK : ERROR; }

NO_VALUES(Integer, int)
NO_VALUES(Boolean, int)
NO_VALUES(String, fmi2String)

EXPORT int fmi2GetFMUstate(fmi2Component own, void **state) { return keep_state(own, state); }
EXPORT int fmi2SetFMUstate(fmi2Component own, void *state) { return restore_state(own, state); }
EXPORT int fmi2FreeFMUstate(fmi2Component own, void **state) { (void)own; free(*state); *state = NULL; return OK; }
EXPORT int fmi2SerializedFMUstateSize(fmi2Component own, void *state, size_t *size) { (void)own; (void)state; *size = sizeof(instance); return OK; }
EXPORT int fmi2SerializeFMUstate(fmi2Component own, void *state, char bytes[], size_t size) { (void)own; return write_state(state, bytes, size); }
EXPORT int fmi2DeSerializeFMUstate(fmi2Component own, const char bytes[], size_t size, void **state) { (void)own; return read_state(bytes, size, state); }

/* No derivatives of inputs and outputs. */
EXPORT int fmi2GetDirectionalDerivative(fmi2Component own, const fmi2ValueReference z[], size_t m, const fmi2ValueReference v[], size_t n,
                                        const double dv[], double dz[])
{
    (void)own; (void)z; (void)m; (void)v; (void)n; (void)dv; (void)dz;
    return ERROR;
}

EXPORT int fmi2SetRealInputDerivatives(fmi2Component own, const fmi2ValueReference of[], size_t count, const int orders[], const double values[])
{
    (void)own; (void)of; (void)orders; (void)values;
    return count == 0 ? OK : ERROR;
}

EXPORT int fmi2GetRealOutputDerivatives(fmi2Component own, const fmi2ValueReference of[], size_t count, const int orders[], double values[])
{
    (void)own; (void)of; (void)orders; (void)values;
    return count == 0 ? OK : ERROR;
}

/* Steps are done when `fmi2DoStep` returns. */
#define NO_STATUS(type, c) EXPORT int fmi2Get##type##Status(fmi2Component o, int kind, c *value) { (void)o; (void)kind; (void)value; return ERROR; }

EXPORT int fmi2GetStatus(fmi2Component own, int kind, int *value) { (void)own; (void)kind; (void)value; return ERROR; }
NO_STATUS(Real, double)
NO_STATUS(Integer, int)
NO_STATUS(Boolean, int)
NO_STATUS(String, fmi2String)
