"""Whether a recording can be what it says it is: wiring, signs, units, dead sensors, parts where nothing moves."""
