/* FMI 2.0, model exchange and co-simulation. The types are those of the standard, fmi-standard.org. */
#if defined(__GNUC__)
#pragma GCC diagnostic ignored "-Wunused-parameter"
#endif

typedef void *fmi2Component;
typedef unsigned int fmi2ValueReference;
typedef double fmi2Real;
typedef int fmi2Integer;
typedef int fmi2Boolean;
typedef const char *fmi2String;
typedef char fmi2Byte;
typedef void *fmi2FMUstate;
typedef enum { fmi2OK, fmi2Warning, fmi2Discard, fmi2Error, fmi2Fatal, fmi2Pending } fmi2Status;
typedef enum { fmi2ModelExchange, fmi2CoSimulation } fmi2Type;
typedef enum { fmi2DoStepStatus, fmi2PendingStatus, fmi2LastSuccessfulTime, fmi2Terminated } fmi2StatusKind;
typedef void (*fmi2Logger)(void *environment, fmi2String name, fmi2Status status, fmi2String category, fmi2String message, ...);
typedef struct {
    fmi2Logger logger;
    void *(*allocateMemory)(size_t count, size_t size);
    void (*freeMemory)(void *memory);
    void (*stepFinished)(void *environment, fmi2Status status);
    void *environment;
} fmi2CallbackFunctions;
typedef struct {
    fmi2Boolean newDiscreteStatesNeeded;
    fmi2Boolean terminateSimulation;
    fmi2Boolean nominalsOfContinuousStatesChanged;
    fmi2Boolean valuesOfContinuousStatesChanged;
    fmi2Boolean nextEventTimeDefined;
    fmi2Real nextEventTime;
} fmi2EventInfo;

static void fmi2_tell(unit *u, const char *text)
{
    if (u->callback.logger2 != NULL) {
        ((fmi2Logger)u->callback.logger2)(u->environment, u->name, fmi2Error, "logStatusError", text); /* no text has a percent sign */
    }
}

static fmi2Status fmi2_status(int done)
{
    return done ? fmi2OK : fmi2Error;
}

static fmi2Status fmi2_none(unit *u, size_t count, const char *what)
{
    return fmi2_status(count == 0 || unit_refuse(u, "this FMU has no %s", what));
}

UNIT_EXPORT const char *fmi2GetTypesPlatform(void)
{
    return "default";
}

UNIT_EXPORT const char *fmi2GetVersion(void)
{
    return "2.0";
}

UNIT_EXPORT fmi2Status fmi2SetDebugLogging(fmi2Component c, fmi2Boolean on, size_t n, const fmi2String categories[])
{
    return fmi2OK; /* errors are always told, and there is nothing else to tell */
}

UNIT_EXPORT fmi2Component fmi2Instantiate(fmi2String name, fmi2Type type, fmi2String token, fmi2String resources,
                                          const fmi2CallbackFunctions *functions, fmi2Boolean visible, fmi2Boolean logging)
{
    unit *u = unit_create(name);
    if (u == NULL || functions == NULL) {
        unit_free(u);
        return NULL;
    }
    u->callback.logger2 = (void (*)(void))functions->logger;
    u->environment = functions->environment;
    u->tell = fmi2_tell;
    u->exchange = type == fmi2ModelExchange;
    if (token == NULL || strcmp(token, MACHINE_TOKEN) != 0) {
        unit_refuse(u, "the GUID is not that of modelDescription.xml, " MACHINE_TOKEN);
        unit_free(u);
        return NULL;
    }
    return u;
}

UNIT_EXPORT void fmi2FreeInstance(fmi2Component c)
{
    unit_free(c);
}

UNIT_EXPORT fmi2Status fmi2SetupExperiment(fmi2Component c, fmi2Boolean toleranceDefined, fmi2Real tolerance,
                                           fmi2Real start, fmi2Boolean stopDefined, fmi2Real stop)
{
    ((unit *)c)->m.now.x.t = start;
    return fmi2OK;
}

UNIT_EXPORT fmi2Status fmi2EnterInitializationMode(fmi2Component c)
{
    ((unit *)c)->m.phase = UNIT_STARTING;
    return fmi2OK;
}

UNIT_EXPORT fmi2Status fmi2ExitInitializationMode(fmi2Component c)
{
    return fmi2_status(unit_start(c));
}

UNIT_EXPORT fmi2Status fmi2Terminate(fmi2Component c)
{
    return fmi2OK;
}

UNIT_EXPORT fmi2Status fmi2Reset(fmi2Component c)
{
    unit_reset(c);
    return fmi2OK;
}

UNIT_EXPORT fmi2Status fmi2GetReal(fmi2Component c, const fmi2ValueReference r[], size_t n, fmi2Real values[])
{
    return fmi2_status(unit_get(c, r, n, values));
}

UNIT_EXPORT fmi2Status fmi2SetReal(fmi2Component c, const fmi2ValueReference r[], size_t n, const fmi2Real values[])
{
    return fmi2_status(unit_set_all(c, r, n, values));
}

#define UNIT_NO_VALUES(Type)                                                                                     \
    UNIT_EXPORT fmi2Status fmi2Get##Type(fmi2Component c, const fmi2ValueReference r[], size_t n, fmi2##Type v[]) \
    {                                                                                                            \
        return fmi2_none(c, n, #Type);                                                                           \
    }                                                                                                            \
    UNIT_EXPORT fmi2Status fmi2Set##Type(fmi2Component c, const fmi2ValueReference r[], size_t n,                \
                                         const fmi2##Type v[])                                                   \
    {                                                                                                            \
        return fmi2_none(c, n, #Type);                                                                           \
    }

UNIT_NO_VALUES(Integer)
UNIT_NO_VALUES(Boolean)
UNIT_NO_VALUES(String)

UNIT_EXPORT fmi2Status fmi2GetFMUstate(fmi2Component c, fmi2FMUstate *state)
{
    return fmi2_status(unit_remember(c, state));
}

UNIT_EXPORT fmi2Status fmi2SetFMUstate(fmi2Component c, fmi2FMUstate state)
{
    memcpy(&((unit *)c)->m, state, sizeof(unit_memory));
    return fmi2OK;
}

UNIT_EXPORT fmi2Status fmi2FreeFMUstate(fmi2Component c, fmi2FMUstate *state)
{
    free(*state);
    *state = NULL;
    return fmi2OK;
}

UNIT_EXPORT fmi2Status fmi2SerializedFMUstateSize(fmi2Component c, fmi2FMUstate state, size_t *size)
{
    *size = sizeof(unit_memory);
    return fmi2OK;
}

UNIT_EXPORT fmi2Status fmi2SerializeFMUstate(fmi2Component c, fmi2FMUstate state, fmi2Byte bytes[], size_t size)
{
    return fmi2_status(unit_write(c, state, bytes, size));
}

UNIT_EXPORT fmi2Status fmi2DeSerializeFMUstate(fmi2Component c, const fmi2Byte bytes[], size_t size, fmi2FMUstate *state)
{
    return fmi2_status(unit_read(c, bytes, size, state));
}

UNIT_EXPORT fmi2Status fmi2GetDirectionalDerivative(fmi2Component c, const fmi2ValueReference unknown[], size_t unknowns,
                                                    const fmi2ValueReference known[], size_t knowns,
                                                    const fmi2Real seed[], fmi2Real values[])
{
    return fmi2_none(c, unknowns, "directional derivatives");
}

/* model exchange */

UNIT_EXPORT fmi2Status fmi2EnterEventMode(fmi2Component c)
{
    return fmi2OK;
}

UNIT_EXPORT fmi2Status fmi2NewDiscreteStates(fmi2Component c, fmi2EventInfo *info)
{
    memset(info, 0, sizeof *info);
    info->valuesOfContinuousStatesChanged = unit_event(c);
    return fmi2OK;
}

UNIT_EXPORT fmi2Status fmi2EnterContinuousTimeMode(fmi2Component c)
{
    return fmi2OK;
}

UNIT_EXPORT fmi2Status fmi2CompletedIntegratorStep(fmi2Component c, fmi2Boolean final, fmi2Boolean *event,
                                                   fmi2Boolean *terminate)
{
    *event = unit_after_step(c, 0);
    *terminate = 0;
    return fmi2OK;
}

UNIT_EXPORT fmi2Status fmi2SetTime(fmi2Component c, fmi2Real time)
{
    ((unit *)c)->m.now.x.t = time;
    return fmi2OK;
}

UNIT_EXPORT fmi2Status fmi2SetContinuousStates(fmi2Component c, const fmi2Real x[], size_t n)
{
    return fmi2_status(unit_take_states(c, x, n));
}

UNIT_EXPORT fmi2Status fmi2GetDerivatives(fmi2Component c, fmi2Real values[], size_t n)
{
    return fmi2_status(unit_states(c, values, n, FIRST_DERIVATIVE));
}

UNIT_EXPORT fmi2Status fmi2GetContinuousStates(fmi2Component c, fmi2Real values[], size_t n)
{
    return fmi2_status(unit_states(c, values, n, FIRST_STATE));
}

UNIT_EXPORT fmi2Status fmi2GetNominalsOfContinuousStates(fmi2Component c, fmi2Real values[], size_t n)
{
    return fmi2_status(unit_nominals(c, values, n));
}

UNIT_EXPORT fmi2Status fmi2GetEventIndicators(fmi2Component c, fmi2Real values[], size_t n)
{
    return fmi2_status(unit_indicators(c, values, n));
}

/* co-simulation */

UNIT_EXPORT fmi2Status fmi2SetRealInputDerivatives(fmi2Component c, const fmi2ValueReference r[], size_t n,
                                                   const fmi2Integer order[], const fmi2Real values[])
{
    return fmi2_none(c, n, "input derivatives: inputs are held");
}

UNIT_EXPORT fmi2Status fmi2GetRealOutputDerivatives(fmi2Component c, const fmi2ValueReference r[], size_t n,
                                                    const fmi2Integer order[], fmi2Real values[])
{
    return fmi2_none(c, n, "output derivatives");
}

UNIT_EXPORT fmi2Status fmi2DoStep(fmi2Component c, fmi2Real time, fmi2Real length, fmi2Boolean final)
{
    return fmi2_status(unit_advance(c, time, length));
}

UNIT_EXPORT fmi2Status fmi2CancelStep(fmi2Component c)
{
    return fmi2_none(c, 1, "steps that go on in the background");
}

UNIT_EXPORT fmi2Status fmi2GetStatus(fmi2Component c, const fmi2StatusKind kind, fmi2Status *value)
{
    *value = fmi2OK;
    return fmi2OK;
}

UNIT_EXPORT fmi2Status fmi2GetRealStatus(fmi2Component c, const fmi2StatusKind kind, fmi2Real *value)
{
    *value = ((unit *)c)->m.now.x.t;
    return fmi2OK;
}

UNIT_EXPORT fmi2Status fmi2GetIntegerStatus(fmi2Component c, const fmi2StatusKind kind, fmi2Integer *value)
{
    *value = 0;
    return fmi2OK;
}

UNIT_EXPORT fmi2Status fmi2GetBooleanStatus(fmi2Component c, const fmi2StatusKind kind, fmi2Boolean *value)
{
    *value = 0;
    return fmi2OK;
}

UNIT_EXPORT fmi2Status fmi2GetStringStatus(fmi2Component c, const fmi2StatusKind kind, fmi2String *value)
{
    *value = "";
    return fmi2OK;
}
