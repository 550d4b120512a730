"""A machine as one C99 file and its header: structs, values of the machine file, step, outputs, derivatives."""

from pneumo_ros import __version__
from pneumo_ros.export.identifiers import comment, identifier
from pneumo_ros.export.machine import EFFORT, Exported
from pneumo_ros.export.signature import number_text
from pneumo_ros.export.structs import structs
from pneumo_ros.export.translation import functions_text

_HEADER = """\
/* The machine "{name}" as C99, written by pneumo_ros {version}; change the machine file, not this.
 *
 *     {m}_parameters p;
 *     {m}_state x;
 *     {m}_input u = {{0.0}};
 *     {m}_output o;
 *     {m}_parameters_default(&p);      values of the machine file
 *     {m}_init(&x, &p);                at rest, pressures atmospheric
 *     {m}_step(&x, &u, &p, {step});    one integration step of {step} s, the inputs held
 *     {m}_outputs(&x, &u, &p, &o);
 *
 * Effects: {effects}.
 * SI units, pressures absolute. Positive y extends the rod; forces are positive against positive velocity.
 * No memory is allocated and nothing is kept between calls. A double must be an IEEE 754 binary64, computed as such:
 * no -ffast-math. On a processor without doubles in hardware the step takes correspondingly longer.
 */
#ifndef {M}_H
#define {M}_H

#ifdef __cplusplus
extern "C" {{
#endif

#define {M}_STEP {step} /* s, usual step; twice as long is less accurate, much longer may be unstable */

{structs}

/* Parameters to the values of the machine file. */
void {m}_parameters_default({m}_parameters *p);

/* State at time 0: at rest, pressures atmospheric. Change members afterwards to start elsewhere. */
void {m}_init({m}_state *x, const {m}_parameters *p);

/* One integration step of dt seconds; x->t goes on by dt. */
void {m}_step({m}_state *x, const {m}_input *u, const {m}_parameters *p, double dt);

/* The same `steps` times, the input held. */
void {m}_advance({m}_state *x, const {m}_input *u, const {m}_parameters *p, double dt, unsigned long steps);

/* Readings of the sensors, forces and flows in this state. */
void {m}_outputs(const {m}_state *x, const {m}_input *u, const {m}_parameters *p, {m}_output *o);

/* Right-hand sides of the differential equations, dx/dt; dx->t is 1. */
void {m}_derivatives(const {m}_state *x, const {m}_input *u, const {m}_parameters *p, {m}_state *dx);

/* What happens once after each step: play, hysteresis. For an integrator of your own; {m}_step does it by itself. */
void {m}_after_step({m}_state *x, const {m}_input *u, const {m}_parameters *p);

#ifdef __cplusplus
}}
#endif

#endif
"""

_SOURCE = """\
/* The machine "{name}" as C99, written by pneumo_ros {version}; its interface is {header}. */
#include "{header}"

#include <math.h>
#include <stdint.h>
#include <string.h>

#ifdef __FAST_MATH__
#error "compile without -ffast-math: it changes the rounding that the elementary functions rely on"
#endif

#ifndef MACHINE_FUNCTION
#define MACHINE_FUNCTION static /* faster and larger with gcc: static inline __attribute__((always_inline)) */
#endif

{functions}

void {m}_parameters_default({m}_parameters *p)
{{
{values}
}}

void {m}_init({m}_state *x, const {m}_parameters *p)
{{
    (void)p;
    x->t = 0.0;
{start}
}}

void {m}_advance({m}_state *x, const {m}_input *u, const {m}_parameters *p, double dt, unsigned long steps)
{{
    const {m}_parameters q = *p;
{load}
    for (unsigned long k = 0; k < steps; ++k) {{
        const double t = x->t + (double)k * dt;
        {step_call};
    }}
{store}
    x->t += (double)steps * dt;
}}

void {m}_step({m}_state *x, const {m}_input *u, const {m}_parameters *p, double dt)
{{
    {m}_advance(x, u, p, dt, 1);
}}

void {m}_outputs(const {m}_state *x, const {m}_input *u, const {m}_parameters *p, {m}_output *o)
{{
    {outputs_call};
    o->{effort_member} = {effort};
}}

void {m}_derivatives(const {m}_state *x, const {m}_input *u, const {m}_parameters *p, {m}_state *dx)
{{
{rates}
    {derivatives_call};
    dx->t = 1.0;
}}

void {m}_after_step({m}_state *x, const {m}_input *u, const {m}_parameters *p)
{{
    {after_call};
}}
"""


def c_files(machine: Exported, header: str) -> tuple[str, str]:
    """Texts of the header, to be named `header`, and of the source; UsageError for what C cannot say."""
    functions, signatures = functions_text(machine)
    m = machine.prefix
    names = {"name": comment(machine.model.name), "version": __version__, "m": m, "M": m.upper(), "header": header}
    head = _HEADER.format(
        structs="\n\n".join(structs(machine)), step=number_text(machine.step),
        effects=comment(", ".join(machine.model.effects) or "none"), **names,
    )  # fmt: skip
    targets = [f"&x->{v.member}" for v in machine.states]
    rates = signatures["derivatives"].width - len(machine.states)
    source = _SOURCE.format(
        functions=functions,
        values="\n".join(f"    p->{v.member} = {number_text(v.start)};" for v in machine.parameters),
        start="\n".join(_start(machine)),
        load="\n".join(_loads(machine)),
        store="\n".join(f"    x->{v.member} = {v.member};" for v in machine.states),
        step_call=_call(m, "step", _locals(machine), ["t", "dt", "&q"], [f"&{v.member}" for v in machine.states]),
        outputs_call=_call(m, "observation", _members(machine), ["x->t", "p"], _observed(machine)),
        effort_member=identifier(EFFORT), effort=_effort(machine),
        rates=f"    double rates[{rates}]; /* of decay, which only the step needs */" if rates else "",
        derivatives_call=_call(m, "derivatives", _members(machine), ["x->t", "p"], _slopes(machine, rates)),
        after_call=_call(m, "after_step", _members(machine), ["x->t", "p"], targets),
        **names,
    )  # fmt: skip
    return head, source


def _call(prefix: str, name: str, variables: list[str], further: list[str], targets: list[str]) -> str:
    return f"{prefix}_fn_{name}({', '.join([*variables, *further, *targets])})"


def _locals(machine: Exported) -> list[str]:
    return [v.member for v in (*machine.states, *machine.inputs)]


def _members(machine: Exported) -> list[str]:
    return [f"x->{v.member}" for v in machine.states] + [f"u->{v.member}" for v in machine.inputs]


def _observed(machine: Exported) -> list[str]:
    return [f"&o->{v.member}" for v in machine.outputs if v.name != EFFORT]


def _slopes(machine: Exported, rates: int) -> list[str]:
    return [f"&dx->{v.member}" for v in machine.states] + [f"&rates[{i}]" for i in range(rates)]


def _effort(machine: Exported) -> str:
    if machine.model.force_driven:
        return "o->drive"
    area_a, area_b, p_atm = "p->piston.area_a", "p->piston.area_b", "p->air.atmospheric_pressure"
    return f"(({area_a} * x->p_a) - ({area_b} * x->p_b)) - ({p_atm} * ({area_a} - {area_b}))"


def _start(machine: Exported) -> list[str]:
    """Constants and parameters first, then the states that start as another one does."""
    states = {v.name: v for v in machine.states}
    lines = []
    for v in sorted(machine.states, key=lambda v: v.follows in states):
        other = f"x->{states[v.follows].member}" if v.follows in states else f"p->{v.follows}"
        lines.append(f"    x->{v.member} = {other if v.follows else number_text(v.start)};")
    return lines


def _loads(machine: Exported) -> list[str]:
    states = [f"    double {v.member} = x->{v.member};" for v in machine.states]
    return states + [f"    const double {v.member} = u->{v.member};" for v in machine.inputs]
