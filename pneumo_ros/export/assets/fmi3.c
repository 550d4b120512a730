/* FMI 3.0, model exchange and co-simulation. The types are those of the standard, fmi-standard.org. */
#include <stdbool.h>
#include <stdint.h>

#if defined(__GNUC__)
#pragma GCC diagnostic ignored "-Wunused-parameter"
#endif

typedef void *fmi3Instance;
typedef void *fmi3FMUState;
typedef uint32_t fmi3ValueReference;
typedef float fmi3Float32;
typedef double fmi3Float64;
typedef int8_t fmi3Int8;
typedef uint8_t fmi3UInt8;
typedef int16_t fmi3Int16;
typedef uint16_t fmi3UInt16;
typedef int32_t fmi3Int32;
typedef uint32_t fmi3UInt32;
typedef int64_t fmi3Int64;
typedef uint64_t fmi3UInt64;
typedef bool fmi3Boolean;
typedef bool fmi3Clock;
typedef const char *fmi3String;
typedef uint8_t fmi3Byte;
typedef const fmi3Byte *fmi3Binary;
typedef enum { fmi3OK, fmi3Warning, fmi3Discard, fmi3Error, fmi3Fatal } fmi3Status;
typedef int fmi3DependencyKind;
typedef int fmi3IntervalQualifier;
typedef void (*fmi3Logger)(void *environment, fmi3Status status, fmi3String category, fmi3String message);
typedef void (*fmi3Callback)(void *environment);

static void fmi3_tell(unit *u, const char *text)
{
    if (u->callback.logger3 != NULL) {
        ((fmi3Logger)u->callback.logger3)(u->environment, fmi3Error, "logStatusError", text);
    }
}

static fmi3Status fmi3_status(int done)
{
    return done ? fmi3OK : fmi3Error;
}

static fmi3Status fmi3_none(unit *u, size_t count, const char *what)
{
    return fmi3_status(count == 0 || unit_refuse(u, "this FMU has no %s", what));
}

UNIT_EXPORT const char *fmi3GetVersion(void)
{
    return "3.0";
}

UNIT_EXPORT fmi3Status fmi3SetDebugLogging(fmi3Instance c, fmi3Boolean on, size_t n, const fmi3String categories[])
{
    return fmi3OK; /* errors are always told, and there is nothing else to tell */
}

static fmi3Instance fmi3_create(fmi3String name, fmi3String token, void *environment, fmi3Logger logger, int exchange)
{
    unit *u = unit_create(name);
    if (u == NULL) {
        return NULL;
    }
    u->environment = environment;
    u->callback.logger3 = (void (*)(void))logger;
    u->tell = fmi3_tell;
    u->exchange = exchange;
    if (token == NULL || strcmp(token, MACHINE_TOKEN) != 0) {
        unit_refuse(u, "the token is not that of modelDescription.xml, " MACHINE_TOKEN);
        unit_free(u);
        return NULL;
    }
    return u;
}

UNIT_EXPORT fmi3Instance fmi3InstantiateModelExchange(fmi3String name, fmi3String token, fmi3String resources,
                                                      fmi3Boolean visible, fmi3Boolean logging, void *environment,
                                                      fmi3Logger logger)
{
    return fmi3_create(name, token, environment, logger, 1);
}

UNIT_EXPORT fmi3Instance fmi3InstantiateCoSimulation(fmi3String name, fmi3String token, fmi3String resources,
                                                     fmi3Boolean visible, fmi3Boolean logging, fmi3Boolean events,
                                                     fmi3Boolean early, const fmi3ValueReference intermediate[],
                                                     size_t intermediates, void *environment, fmi3Logger logger,
                                                     fmi3Callback update)
{
    return fmi3_create(name, token, environment, logger, 0);
}

UNIT_EXPORT fmi3Instance fmi3InstantiateScheduledExecution(fmi3String name, fmi3String token, fmi3String resources,
                                                           fmi3Boolean visible, fmi3Boolean logging, void *environment,
                                                           fmi3Logger logger, fmi3Callback clock, fmi3Callback lock,
                                                           fmi3Callback unlock)
{
    return NULL;
}

UNIT_EXPORT void fmi3FreeInstance(fmi3Instance c)
{
    unit_free(c);
}

UNIT_EXPORT fmi3Status fmi3EnterInitializationMode(fmi3Instance c, fmi3Boolean toleranceDefined, fmi3Float64 tolerance,
                                                   fmi3Float64 start, fmi3Boolean stopDefined, fmi3Float64 stop)
{
    unit *u = c;
    u->m.now.x.t = start;
    u->m.phase = UNIT_STARTING;
    return fmi3OK;
}

UNIT_EXPORT fmi3Status fmi3ExitInitializationMode(fmi3Instance c)
{
    return fmi3_status(unit_start(c));
}

#define UNIT_MODE(function)                         \
    UNIT_EXPORT fmi3Status function(fmi3Instance c) \
    {                                               \
        return fmi3OK;                              \
    }

UNIT_MODE(fmi3EnterEventMode)
UNIT_MODE(fmi3EnterStepMode)
UNIT_MODE(fmi3EnterContinuousTimeMode)
UNIT_MODE(fmi3EvaluateDiscreteStates)
UNIT_MODE(fmi3Terminate)

UNIT_EXPORT fmi3Status fmi3EnterConfigurationMode(fmi3Instance c)
{
    return fmi3_none(c, 1, "structural parameters");
}

UNIT_EXPORT fmi3Status fmi3ExitConfigurationMode(fmi3Instance c)
{
    return fmi3_none(c, 1, "structural parameters");
}

UNIT_EXPORT fmi3Status fmi3Reset(fmi3Instance c)
{
    unit_reset(c);
    return fmi3OK;
}

UNIT_EXPORT fmi3Status fmi3GetFloat64(fmi3Instance c, const fmi3ValueReference r[], size_t n, fmi3Float64 values[],
                                      size_t count)
{
    return fmi3_status(unit_counts(c, count, n) && unit_get(c, r, n, values));
}

UNIT_EXPORT fmi3Status fmi3SetFloat64(fmi3Instance c, const fmi3ValueReference r[], size_t n,
                                      const fmi3Float64 values[], size_t count)
{
    return fmi3_status(unit_counts(c, count, n) && unit_set_all(c, r, n, values));
}

#define UNIT_NO_VALUES(Type)                                                                                      \
    UNIT_EXPORT fmi3Status fmi3Get##Type(fmi3Instance c, const fmi3ValueReference r[], size_t n, fmi3##Type v[],  \
                                         size_t count)                                                            \
    {                                                                                                             \
        return fmi3_none(c, n, #Type);                                                                            \
    }                                                                                                             \
    UNIT_EXPORT fmi3Status fmi3Set##Type(fmi3Instance c, const fmi3ValueReference r[], size_t n,                  \
                                         const fmi3##Type v[], size_t count)                                      \
    {                                                                                                             \
        return fmi3_none(c, n, #Type);                                                                            \
    }

UNIT_NO_VALUES(Float32)
UNIT_NO_VALUES(Int8)
UNIT_NO_VALUES(UInt8)
UNIT_NO_VALUES(Int16)
UNIT_NO_VALUES(UInt16)
UNIT_NO_VALUES(Int32)
UNIT_NO_VALUES(UInt32)
UNIT_NO_VALUES(Int64)
UNIT_NO_VALUES(UInt64)
UNIT_NO_VALUES(Boolean)
UNIT_NO_VALUES(String)

UNIT_EXPORT fmi3Status fmi3GetBinary(fmi3Instance c, const fmi3ValueReference r[], size_t n, size_t sizes[],
                                     fmi3Binary v[], size_t count)
{
    return fmi3_none(c, n, "Binary");
}

UNIT_EXPORT fmi3Status fmi3SetBinary(fmi3Instance c, const fmi3ValueReference r[], size_t n, const size_t sizes[],
                                     const fmi3Binary v[], size_t count)
{
    return fmi3_none(c, n, "Binary");
}

UNIT_EXPORT fmi3Status fmi3GetClock(fmi3Instance c, const fmi3ValueReference r[], size_t n, fmi3Clock v[])
{
    return fmi3_none(c, n, "Clock");
}

UNIT_EXPORT fmi3Status fmi3SetClock(fmi3Instance c, const fmi3ValueReference r[], size_t n, const fmi3Clock v[])
{
    return fmi3_none(c, n, "Clock");
}

#define UNIT_NO_INTERVALS(function, first, second)                                                                \
    UNIT_EXPORT fmi3Status function(fmi3Instance c, const fmi3ValueReference r[], size_t n, first a[], second b[]) \
    {                                                                                                             \
        return fmi3_none(c, n, "Clock");                                                                          \
    }
#define UNIT_NO_SHIFT(function, first)                                                                   \
    UNIT_EXPORT fmi3Status function(fmi3Instance c, const fmi3ValueReference r[], size_t n, first a[])    \
    {                                                                                                    \
        return fmi3_none(c, n, "Clock");                                                                 \
    }

UNIT_NO_INTERVALS(fmi3GetIntervalDecimal, fmi3Float64, fmi3IntervalQualifier)
UNIT_NO_INTERVALS(fmi3GetShiftFraction, fmi3UInt64, fmi3UInt64)
UNIT_NO_INTERVALS(fmi3SetIntervalFraction, const fmi3UInt64, const fmi3UInt64)
UNIT_NO_INTERVALS(fmi3SetShiftFraction, const fmi3UInt64, const fmi3UInt64)
UNIT_NO_SHIFT(fmi3GetShiftDecimal, fmi3Float64)
UNIT_NO_SHIFT(fmi3SetIntervalDecimal, const fmi3Float64)
UNIT_NO_SHIFT(fmi3SetShiftDecimal, const fmi3Float64)

UNIT_EXPORT fmi3Status fmi3GetIntervalFraction(fmi3Instance c, const fmi3ValueReference r[], size_t n, fmi3UInt64 a[],
                                               fmi3UInt64 b[], fmi3IntervalQualifier q[])
{
    return fmi3_none(c, n, "Clock");
}

UNIT_EXPORT fmi3Status fmi3GetNumberOfVariableDependencies(fmi3Instance c, fmi3ValueReference r, size_t *count)
{
    return fmi3_none(c, 1, "dependencies of elements");
}

UNIT_EXPORT fmi3Status fmi3GetVariableDependencies(fmi3Instance c, fmi3ValueReference r, size_t elements[],
                                                   fmi3ValueReference independents[], size_t others[],
                                                   fmi3DependencyKind kinds[], size_t count)
{
    return fmi3_none(c, 1, "dependencies of elements");
}

UNIT_EXPORT fmi3Status fmi3GetFMUState(fmi3Instance c, fmi3FMUState *state)
{
    return fmi3_status(unit_remember(c, state));
}

UNIT_EXPORT fmi3Status fmi3SetFMUState(fmi3Instance c, fmi3FMUState state)
{
    memcpy(&((unit *)c)->m, state, sizeof(unit_memory));
    return fmi3OK;
}

UNIT_EXPORT fmi3Status fmi3FreeFMUState(fmi3Instance c, fmi3FMUState *state)
{
    free(*state);
    *state = NULL;
    return fmi3OK;
}

UNIT_EXPORT fmi3Status fmi3SerializedFMUStateSize(fmi3Instance c, fmi3FMUState state, size_t *size)
{
    *size = sizeof(unit_memory);
    return fmi3OK;
}

UNIT_EXPORT fmi3Status fmi3SerializeFMUState(fmi3Instance c, fmi3FMUState state, fmi3Byte bytes[], size_t size)
{
    return fmi3_status(unit_write(c, state, bytes, size));
}

UNIT_EXPORT fmi3Status fmi3DeserializeFMUState(fmi3Instance c, const fmi3Byte bytes[], size_t size, fmi3FMUState *state)
{
    return fmi3_status(unit_read(c, bytes, size, state));
}

UNIT_EXPORT fmi3Status fmi3GetDirectionalDerivative(fmi3Instance c, const fmi3ValueReference unknown[], size_t unknowns,
                                                    const fmi3ValueReference known[], size_t knowns,
                                                    const fmi3Float64 seed[], size_t seeds, fmi3Float64 values[],
                                                    size_t count)
{
    return fmi3_none(c, 1, "directional derivatives");
}

UNIT_EXPORT fmi3Status fmi3GetAdjointDerivative(fmi3Instance c, const fmi3ValueReference unknown[], size_t unknowns,
                                                const fmi3ValueReference known[], size_t knowns,
                                                const fmi3Float64 seed[], size_t seeds, fmi3Float64 values[],
                                                size_t count)
{
    return fmi3_none(c, 1, "adjoint derivatives");
}

UNIT_EXPORT fmi3Status fmi3UpdateDiscreteStates(fmi3Instance c, fmi3Boolean *again, fmi3Boolean *terminate,
                                                fmi3Boolean *nominals, fmi3Boolean *states, fmi3Boolean *timed,
                                                fmi3Float64 *time)
{
    *again = false;
    *terminate = false;
    *nominals = false;
    *states = unit_event(c) != 0;
    *timed = false;
    *time = 0.0;
    return fmi3OK;
}

/* model exchange */

UNIT_EXPORT fmi3Status fmi3CompletedIntegratorStep(fmi3Instance c, fmi3Boolean final, fmi3Boolean *event,
                                                   fmi3Boolean *terminate)
{
    *event = unit_after_step(c, 0) != 0;
    *terminate = false;
    return fmi3OK;
}

UNIT_EXPORT fmi3Status fmi3SetTime(fmi3Instance c, fmi3Float64 time)
{
    ((unit *)c)->m.now.x.t = time;
    return fmi3OK;
}

UNIT_EXPORT fmi3Status fmi3SetContinuousStates(fmi3Instance c, const fmi3Float64 x[], size_t n)
{
    return fmi3_status(unit_take_states(c, x, n));
}

UNIT_EXPORT fmi3Status fmi3GetContinuousStateDerivatives(fmi3Instance c, fmi3Float64 values[], size_t n)
{
    return fmi3_status(unit_states(c, values, n, FIRST_DERIVATIVE));
}

UNIT_EXPORT fmi3Status fmi3GetContinuousStates(fmi3Instance c, fmi3Float64 values[], size_t n)
{
    return fmi3_status(unit_states(c, values, n, FIRST_STATE));
}

UNIT_EXPORT fmi3Status fmi3GetNominalsOfContinuousStates(fmi3Instance c, fmi3Float64 values[], size_t n)
{
    return fmi3_status(unit_nominals(c, values, n));
}

UNIT_EXPORT fmi3Status fmi3GetEventIndicators(fmi3Instance c, fmi3Float64 values[], size_t n)
{
    return fmi3_status(unit_indicators(c, values, n));
}

UNIT_EXPORT fmi3Status fmi3GetNumberOfEventIndicators(fmi3Instance c, size_t *count)
{
    *count = INDICATORS;
    return fmi3OK;
}

UNIT_EXPORT fmi3Status fmi3GetNumberOfContinuousStates(fmi3Instance c, size_t *count)
{
    *count = STATES;
    return fmi3OK;
}

/* co-simulation */

UNIT_EXPORT fmi3Status fmi3GetOutputDerivatives(fmi3Instance c, const fmi3ValueReference r[], size_t n,
                                                const fmi3Int32 order[], fmi3Float64 values[], size_t count)
{
    return fmi3_none(c, n, "output derivatives");
}

UNIT_EXPORT fmi3Status fmi3DoStep(fmi3Instance c, fmi3Float64 time, fmi3Float64 length, fmi3Boolean final,
                                  fmi3Boolean *event, fmi3Boolean *terminate, fmi3Boolean *early, fmi3Float64 *last)
{
    const int done = unit_advance(c, time, length);
    *event = false;
    *terminate = false;
    *early = false;
    *last = done ? time + length : time;
    return fmi3_status(done);
}

UNIT_EXPORT fmi3Status fmi3ActivateModelPartition(fmi3Instance c, fmi3ValueReference clock, fmi3Float64 time)
{
    return fmi3_none(c, 1, "model partitions");
}
