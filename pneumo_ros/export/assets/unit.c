/* One instance of the machine, whichever version of FMI asks. Included after variables.h. */
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#if defined(_WIN32)
#define UNIT_EXPORT __declspec(dllexport)
#elif defined(__GNUC__)
#define UNIT_EXPORT __attribute__((visibility("default")))
#else
#define UNIT_EXPORT
#endif

#define UNIT_REST 1e-6     /* m/s, by which the velocity must pass zero for the event of a reversal */
#define UNIT_MOST_STEPS 1e9 /* integration steps in one communication step */

enum unit_phase { UNIT_CREATED, UNIT_STARTING, UNIT_RUNNING };

/* All that changes: what an FMU state holds. */
typedef struct {
    machine_values now;
    unsigned char given[STATES]; /* whether the state was set before the start */
    int phase;
    double side; /* of the velocity at the last event, 1 or -1 */
} unit_memory;

typedef struct unit {
    unit_memory m;
    int exchange; /* model exchange, where the importer integrates */
    void (*tell)(struct unit *u, const char *text);
    void *environment;
    union {
        void (*logger2)(void);
        void (*logger3)(void);
    } callback;
    char *name;
} unit;

/* Tells the importer what is wrong; returns 0, as functions do that failed. */
static int unit_refuse(unit *u, const char *format, ...)
{
    char text[512];
    va_list values;
    va_start(values, format);
    vsnprintf(text, sizeof text, format, values);
    va_end(values);
    if (u->tell != NULL) {
        u->tell(u, text);
    }
    return 0;
}

static void unit_reset(unit *u)
{
    memset(&u->m, 0, sizeof u->m);
    machine_parameters_default(&u->m.now.p);
    machine_init(&u->m.now.x, &u->m.now.p);
    u->m.now.step = MACHINE_STEP;
    u->m.side = 1.0;
}

static unit *unit_create(const char *name)
{
    unit *u = calloc(1, sizeof *u);
    const size_t length = (name == NULL) ? 0 : strlen(name);
    if (u == NULL) {
        return NULL;
    }
    u->name = calloc(length + 1, 1);
    if (u->name == NULL) {
        free(u);
        return NULL;
    }
    if (length > 0) {
        memcpy(u->name, name, length);
    }
    unit_reset(u);
    return u;
}

static void unit_free(unit *u)
{
    if (u != NULL) {
        free(u->name);
        free(u);
    }
}

/* Finite, in range, and allowed now. */
static int unit_may_set(unit *u, unsigned long reference, double value)
{
    if (!isfinite(value)) {
        return unit_refuse(u, "value %g of variable %lu is not finite", value, reference);
    }
    if (reference >= FIRST_PARAMETER && reference < FIRST_PARAMETER + PARAMETERS) {
        const machine_range *r = &machine_ranges[reference - FIRST_PARAMETER];
        if (value < r->low || value > r->high) {
            return unit_refuse(u, "%s is %g; allowed is %g to %g", r->name, value, r->low, r->high);
        }
        return 1;
    }
    if (reference == STEP_PARAMETER) {
        if (value < 1e-7 || value > 1e-2 || u->m.phase == UNIT_RUNNING) {
            return unit_refuse(u, "integration_step is %g; it takes 1e-7 to 1e-2 s, before the start", value);
        }
        return 1;
    }
    if (reference >= FIRST_STATE && reference < FIRST_STATE + STATES) {
        if (u->m.phase == UNIT_RUNNING && !u->exchange) {
            return unit_refuse(u, "variable %lu is a state; set it before the start", reference);
        }
        return 1;
    }
    if (reference >= FIRST_INPUT && reference < FIRST_INPUT + INPUTS) {
        return 1;
    }
    return unit_refuse(u, "variable %lu cannot be set", reference);
}

static int unit_set(unit *u, unsigned long reference, double value)
{
    if (!unit_may_set(u, reference, value)) {
        return 0;
    }
    *machine_variable(&u->m.now, reference) = value;
    if (reference >= FIRST_STATE && reference < FIRST_STATE + STATES) {
        u->m.given[reference - FIRST_STATE] = 1;
    }
    return 1;
}

static int unit_set_all(unit *u, const unsigned int *references, size_t count, const double *values)
{
    for (size_t i = 0; i < count; ++i) {
        if (!unit_set(u, references[i], values[i])) {
            return 0;
        }
    }
    return 1;
}

static int unit_counts(unit *u, size_t given, size_t needed)
{
    return given == needed || unit_refuse(u, "%lu values given, %lu needed", (unsigned long)given, (unsigned long)needed);
}

/* Both ends of the stroke, and reversals, where the piston sticks or breaks away. */
static int unit_indicators(unit *u, double *values, size_t count)
{
    const double reach = 0.5 * u->m.now.p.piston.stroke;
    if (!unit_counts(u, count, INDICATORS)) {
        return 0;
    }
    values[0] = reach - u->m.now.x.y;
    values[1] = reach + u->m.now.x.y;
    values[2] = u->m.now.x.v + UNIT_REST * u->m.side;
    return 1;
}

/* Outputs and derivatives are computed when they are asked for. */
static int unit_get(unit *u, const unsigned int *references, size_t count, double *values)
{
    machine_values *m = &u->m.now;
    int slopes = 0, outputs = 0;
    unit_indicators(u, m->indicators, INDICATORS);
    if (u->m.phase != UNIT_RUNNING) {
        machine_follow(m, u->m.given);
    }
    for (size_t i = 0; i < count; ++i) {
        const unsigned long r = references[i];
        const double *place = machine_variable(m, r);
        if (place == NULL) {
            return unit_refuse(u, "there is no variable %lu", r);
        }
        if (!outputs && r >= FIRST_OUTPUT && r < FIRST_OUTPUT + OUTPUTS) {
            machine_outputs(&m->x, &m->u, &m->p, &m->o);
            outputs = 1;
        }
        if (!slopes && r >= FIRST_DERIVATIVE && r < FIRST_DERIVATIVE + STATES) {
            machine_derivatives(&m->x, &m->u, &m->p, &m->dx);
            slopes = 1;
        }
        values[i] = *place;
    }
    return 1;
}

static int unit_start(unit *u)
{
    const char *problem = machine_unfit(&u->m.now.p);
    if (problem != NULL) {
        return unit_refuse(u, "%s", problem);
    }
    machine_follow(&u->m.now, u->m.given);
    u->m.side = (u->m.now.x.v < 0.0) ? -1.0 : 1.0;
    u->m.phase = UNIT_RUNNING;
    return 1;
}

/* One communication step from `time`, in equal integration steps no longer than integration_step. */
static int unit_advance(unit *u, double time, double length)
{
    const machine_state before = u->m.now.x;
    const double steps = fmax(1.0, ceil(length / u->m.now.step - 1e-9));
    if (u->m.phase != UNIT_RUNNING) {
        return unit_refuse(u, "a step was asked for before the initialization ended");
    }
    if (!(isfinite(time) && length > 0.0 && steps <= UNIT_MOST_STEPS)) {
        return unit_refuse(u, "communication step %g s; it takes more than 0, at most 1e9 integration steps", length);
    }
    u->m.now.x.t = time;
    machine_advance(&u->m.now.x, &u->m.now.u, &u->m.now.p, length / steps, (unsigned long)steps);
    for (unsigned long i = 0; i < STATES; ++i) {
        if (!isfinite(*machine_variable(&u->m.now, FIRST_STATE + i))) {
            u->m.now.x = before;
            return unit_refuse(u, "the state left the finite numbers after t = %g s; take a shorter integration_step", time);
        }
    }
    return 1;
}

/* Play and hysteresis after a step of the importer's integrator; whether a state changes. */
static int unit_after_step(unit *u, int keep)
{
    machine_state next = u->m.now.x;
    machine_after_step(&next, &u->m.now.u, &u->m.now.p);
    if (memcmp(&next, &u->m.now.x, sizeof next) == 0) {
        return 0;
    }
    if (keep) {
        u->m.now.x = next;
    }
    return 1;
}

/* An event: whether a state changed in it. */
static int unit_event(unit *u)
{
    const int changed = unit_after_step(u, 1);
    u->m.side = (u->m.now.x.v < 0.0) ? -1.0 : 1.0;
    return changed;
}

/* States, or derivatives of states. */
static int unit_states(unit *u, double *values, size_t count, unsigned long first)
{
    if (!unit_counts(u, count, STATES)) {
        return 0;
    }
    if (first == FIRST_DERIVATIVE) {
        machine_derivatives(&u->m.now.x, &u->m.now.u, &u->m.now.p, &u->m.now.dx);
    }
    for (unsigned long i = 0; i < STATES; ++i) {
        values[i] = *machine_variable(&u->m.now, first + i);
    }
    return 1;
}

static int unit_take_states(unit *u, const double *values, size_t count)
{
    if (!unit_counts(u, count, STATES)) {
        return 0;
    }
    for (unsigned long i = 0; i < STATES; ++i) {
        *machine_variable(&u->m.now, FIRST_STATE + i) = values[i];
    }
    return 1;
}

static int unit_nominals(unit *u, double *values, size_t count)
{
    if (!unit_counts(u, count, STATES)) {
        return 0;
    }
    memcpy(values, machine_nominals, sizeof machine_nominals);
    return 1;
}

static int unit_remember(unit *u, void **state)
{
    if (*state == NULL) {
        *state = malloc(sizeof(unit_memory));
    }
    if (*state == NULL) {
        return unit_refuse(u, "out of memory");
    }
    memcpy(*state, &u->m, sizeof(unit_memory));
    return 1;
}

static int unit_write(unit *u, const void *state, void *bytes, size_t size)
{
    if (size < sizeof(unit_memory)) {
        return unit_refuse(u, "%lu bytes are too few for a state", (unsigned long)size);
    }
    memcpy(bytes, state, sizeof(unit_memory));
    return 1;
}

static int unit_read(unit *u, const void *bytes, size_t size, void **state)
{
    if (size != sizeof(unit_memory)) {
        return unit_refuse(u, "%lu bytes are no state of this FMU", (unsigned long)size);
    }
    if (!unit_remember(u, state)) {
        return 0;
    }
    memcpy(*state, bytes, size);
    return 1;
}
