
/* FMI 3.0 */

typedef void *fmi3Instance;
typedef void *fmi3InstanceEnvironment;
typedef void *fmi3FMUState;
typedef uint32_t fmi3ValueReference;
typedef const char *fmi3String;
typedef int fmi3Status;
typedef LOG fmi3LogMessageCallback;
typedef void (*fmi3Callback)(void);

static fmi3Status checked(const instance *own, const char *message)
{
    if (message && own->log) own->log(own->environment, ERROR, "error", message);
    return message ? ERROR : OK;
}

EXPORT const char *fmi3GetVersion(void) { return "3.0"; }

EXPORT fmi3Status fmi3SetDebugLogging(fmi3Instance own, bool on, size_t count, const fmi3String categories[])
{
    (void)own; (void)on; (void)count; (void)categories;
    return OK;
}

EXPORT fmi3Instance fmi3InstantiateModelExchange(fmi3String name, fmi3String token, fmi3String resources, bool visible, bool logging,
                                                 fmi3InstanceEnvironment environment, fmi3LogMessageCallback log)
{
    (void)name; (void)token; (void)resources; (void)visible; (void)logging; (void)environment; (void)log;
    return NULL;
}

EXPORT fmi3Instance fmi3InstantiateScheduledExecution(fmi3String name, fmi3String token, fmi3String resources, bool visible, bool logging,
                                                      fmi3InstanceEnvironment environment, fmi3LogMessageCallback log, fmi3Callback clock,
                                                      fmi3Callback lock, fmi3Callback unlock)
{
    (void)name; (void)token; (void)resources; (void)visible; (void)logging; (void)environment; (void)log; (void)clock; (void)lock; (void)unlock;
    return NULL;
}

EXPORT fmi3Instance fmi3InstantiateCoSimulation(fmi3String name, fmi3String token, fmi3String resources, bool visible, bool logging,
                                                bool events, bool early, const fmi3ValueReference required[], size_t count,
                                                fmi3InstanceEnvironment environment, fmi3LogMessageCallback log, fmi3Callback update)
{
    instance *own;
    (void)name; (void)resources; (void)visible; (void)logging; (void)events; (void)early; (void)required; (void)count; (void)update;
    if (!token || strcmp(token, TOKEN) != 0) {
        if (log) log(environment, ERROR, "error", "the token is that of another model");
        return NULL;
    }
    own = malloc(sizeof *own);
    if (!own) return NULL;
    own->environment = environment;
    own->log = log;
    begin(own);
    return own;
}

EXPORT void fmi3FreeInstance(fmi3Instance own) { free(own); }

EXPORT fmi3Status fmi3EnterInitializationMode(fmi3Instance own, bool tolerant, double tolerance, double start, bool stops, double stop)
{
    (void)tolerant; (void)tolerance; (void)stops; (void)stop;
    return checked(own, start == 0.0 ? NULL : "the motion begins at t = 0");
}

EXPORT fmi3Status fmi3ExitInitializationMode(fmi3Instance own) { return checked(own, run_from_start(own)); }
EXPORT fmi3Status fmi3EnterConfigurationMode(fmi3Instance own) { (void)own; return OK; }
EXPORT fmi3Status fmi3ExitConfigurationMode(fmi3Instance own) { (void)own; return OK; }
EXPORT fmi3Status fmi3EnterStepMode(fmi3Instance own) { (void)own; return OK; }
EXPORT fmi3Status fmi3Terminate(fmi3Instance own) { (void)own; return OK; }

EXPORT fmi3Status fmi3Reset(fmi3Instance own) { begin(own); return OK; }

EXPORT fmi3Status fmi3DoStep(fmi3Instance of, double now, double size, bool forward, bool *event, bool *terminate, bool *early, double *reached)
{
    instance *own = of;
    fmi3Status status;
    (void)forward;
    *event = *terminate = *early = false;
    status = checked(own, move_on(own, now, size));
    *reached = own->time;
    return status;
}

EXPORT fmi3Status fmi3GetFloat64(fmi3Instance own, const fmi3ValueReference references[], size_t count, double values[], size_t size)
{
    return checked(own, size != count ? "every variable is one number" : read_values(own, references, count, values));
}

EXPORT fmi3Status fmi3SetFloat64(fmi3Instance own, const fmi3ValueReference references[], size_t count, const double values[], size_t size)
{
    return checked(own, size != count ? "every variable is one number" : write_values(own, references, count, values));
}

EXPORT fmi3Status fmi3GetFMUState(fmi3Instance own, fmi3FMUState *state) { return keep_state(own, state); }
EXPORT fmi3Status fmi3SetFMUState(fmi3Instance own, fmi3FMUState state) { return restore_state(own, state); }
EXPORT fmi3Status fmi3FreeFMUState(fmi3Instance own, fmi3FMUState *state) { (void)own; free(*state); *state = NULL; return OK; }

EXPORT fmi3Status fmi3SerializedFMUStateSize(fmi3Instance own, fmi3FMUState state, size_t *size)
{
    (void)own; (void)state;
    *size = sizeof(instance);
    return OK;
}

EXPORT fmi3Status fmi3SerializeFMUState(fmi3Instance own, fmi3FMUState state, uint8_t bytes[], size_t size)
{
    (void)own;
    return write_state(state, bytes, size);
}

EXPORT fmi3Status fmi3DeserializeFMUState(fmi3Instance own, const uint8_t bytes[], size_t size, fmi3FMUState *state)
{
    (void)own;
    return read_state(bytes, size, state);
}

/* Variables of other types there are none, and no derivatives, dependencies, clocks or events. */
#define NONE(name, arguments) EXPORT fmi3Status name arguments { return ERROR; }
#define NO_VALUES(type, c) \
    EXPORT fmi3Status fmi3Get##type(fmi3Instance o, const fmi3ValueReference r[], size_t n, c v[], size_t m) \
    { (void)o; (void)r; (void)v; (void)m; return n == 0 ? OK : ERROR; } \
    EXPORT fmi3Status fmi3Set##type(fmi3Instance o, const fmi3ValueReference r[], size_t n, const c v[], size_t m) \
    { (void)o; (void)r; (void)v; (void)m; return n == 0 ? OK : ERROR; }

NO_VALUES(Float32, float)
NO_VALUES(Int8, int8_t)
NO_VALUES(UInt8, uint8_t)
NO_VALUES(Int16, int16_t)
NO_VALUES(UInt16, uint16_t)
NO_VALUES(Int32, int32_t)
NO_VALUES(UInt32, uint32_t)
NO_VALUES(Int64, int64_t)
NO_VALUES(UInt64, uint64_t)
NO_VALUES(Boolean, bool)
NO_VALUES(String, fmi3String)
NONE(fmi3GetBinary, (void))
NONE(fmi3SetBinary, (void))
NONE(fmi3GetClock, (void))
NONE(fmi3SetClock, (void))
NONE(fmi3EnterEventMode, (void))
NONE(fmi3GetNumberOfVariableDependencies, (void))
NONE(fmi3GetVariableDependencies, (void))
NONE(fmi3GetDirectionalDerivative, (void))
NONE(fmi3GetAdjointDerivative, (void))
NONE(fmi3GetOutputDerivatives, (void))
NONE(fmi3GetIntervalDecimal, (void))
NONE(fmi3GetIntervalFraction, (void))
NONE(fmi3GetShiftDecimal, (void))
NONE(fmi3GetShiftFraction, (void))
NONE(fmi3SetIntervalDecimal, (void))
NONE(fmi3SetIntervalFraction, (void))
NONE(fmi3SetShiftDecimal, (void))
NONE(fmi3SetShiftFraction, (void))
NONE(fmi3EvaluateDiscreteStates, (void))
NONE(fmi3UpdateDiscreteStates, (void))
NONE(fmi3EnterContinuousTimeMode, (void))
NONE(fmi3CompletedIntegratorStep, (void))
NONE(fmi3SetTime, (void))
NONE(fmi3SetContinuousStates, (void))
NONE(fmi3GetContinuousStateDerivatives, (void))
NONE(fmi3GetEventIndicators, (void))
NONE(fmi3GetContinuousStates, (void))
NONE(fmi3GetNominalsOfContinuousStates, (void))
NONE(fmi3GetNumberOfEventIndicators, (void))
NONE(fmi3GetNumberOfContinuousStates, (void))
NONE(fmi3ActivateModelPartition, (void))
