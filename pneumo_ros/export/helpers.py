"""Small C functions that stand for Python's and the compiled kernel's own."""

HELPERS = {
    "min": """MACHINE_FUNCTION double kernel_min(double a, double b)
{
    return (b < a) ? b : a;
}""",
    "max": """MACHINE_FUNCTION double kernel_max(double a, double b)
{
    return (b > a) ? b : a;
}""",
    "modulo": """MACHINE_FUNCTION double kernel_modulo(double a, double b)
{
    const double rest = fmod(a, b); /* Python: the sign of the divisor */
    return ((rest != 0.0) && ((rest < 0.0) != (b < 0.0))) ? (rest + b) : rest;
}""",
    "quotient": """MACHINE_FUNCTION double kernel_quotient(double a, double b)
{
    return rint((a - kernel_modulo(a, b)) / b);
}""",
    "power": """MACHINE_FUNCTION double kernel_power(double x, int n)
{
    double result = 1.0;
    unsigned int left = (n < 0) ? (0u - (unsigned int)n) : (unsigned int)n;
    while (left != 0u) {
        if ((left & 1u) != 0u) {
            result *= x;
        }
        left >>= 1;
        x *= x;
    }
    return (n < 0) ? (1.0 / result) : result;
}""",
    "power_of_two": """MACHINE_FUNCTION double kernel_power_of_two(double k)
{
    const uint64_t bits = (uint64_t)((int64_t)k + 1023) << 52;
    double result;
    memcpy(&result, &bits, sizeof result);
    return result;
}""",
    "exponent": """MACHINE_FUNCTION double kernel_exponent(double x)
{
    uint64_t bits;
    memcpy(&bits, &x, sizeof bits);
    return (double)(int32_t)(bits >> 52) - 1023.0;
}""",
    "mantissa": """MACHINE_FUNCTION double kernel_mantissa(double x)
{
    uint64_t bits;
    memcpy(&bits, &x, sizeof bits);
    bits = (bits & 0x000FFFFFFFFFFFFFu) | 0x3FF0000000000000u;
    memcpy(&x, &bits, sizeof x);
    return x;
}""",
}


def helpers_text(used: set[str]) -> str:
    """The helpers named, in an order in which each is defined before it is called."""
    return "\n\n".join(text for name, text in HELPERS.items() if name in used)
