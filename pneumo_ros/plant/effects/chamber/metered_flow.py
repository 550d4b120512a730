"""The flow that a flow meter in the line of chamber a measures."""

from pneumo_ros.plant.effect import Effect, Parameter


class MeteredFlow(Effect):
    """The flow through port a is what a flow meter there measures: q_a = (1 - s) q_valve + s q_meter.

    With s = 1 the valve's law does not matter to chamber a: its leaks, volume and heat are judged by themselves.
    """

    share = Parameter(1.0, "1", "share s of the flow that the flow meter tells", low=0.0, high=2.0, neutral=0.0)

    source = "balance of mass"
    signature = "the flow error of chamber a follows what the flow meter reads beyond the valve's law"

    def equations(port_flow_a, metered_flow_a, share):
        port_flow_a = port_flow_a + share * (metered_flow_a - port_flow_a)
        return port_flow_a
