"""Elementary functions for the equations of effects, with one source for Python, scalar and vector code.

The same source runs in pure Python, compiles to scalar machine code and vectorises over lanes: no branch that LLVM
cannot turn into a select, no call into libm. Hence compiled and interpreted results agree to the last bit. Rational
approximations of log and atan and the reduction of exp's argument are those of the Cephes library (S. L. Moshier,
1989); exp and sin are polynomials through Chebyshev points, in Estrin's scheme, because a division would take longer.
Relative errors are a few units in the last place.
"""

import math

pi = math.pi
_ROUND = 6755399441055744.0  # 1.5 * 2**52: adding and subtracting it rounds to the nearest integer


def power_of_two(k: float) -> float:
    """2**k for an integral float k in [-1022, 1023]; compiled kernels replace it by a shift into the exponent."""
    return math.ldexp(1.0, int(k))


def exponent(x: float) -> float:
    """Unbiased binary exponent e of a positive normal x = m 2**e with 1 <= m < 2 (replaced by a bit operation)."""
    return float(math.frexp(x)[1] - 1)


def mantissa(x: float) -> float:
    """Mantissa m in [1, 2) of a positive normal x = m 2**e (replaced by a bit operation)."""
    return 2.0 * math.frexp(x)[0]


def sqrt(x: float) -> float:
    """Square root; the argument must not be negative."""
    return math.sqrt(x)


def exp(x: float) -> float:
    """Exponential; the argument is limited to [-708, 709], where double precision ends."""
    x = min(max(x, -708.0), 709.0)
    k = (x * 1.4426950408889634 + _ROUND) - _ROUND
    r = x - k * 6.93145751953125e-1 - k * 1.42860682030941723212e-6
    s = r * r
    f = s * s
    low = (0.5000000000000001 + r * 0.16666666666666669) + s * (0.041666666666624164 + r * 0.008333333333330065)
    mid = (1.3888888917196719e-3 + r * 1.9841269863040545e-4) + s * (2.4801521322368692e-5 + r * 2.7557268480310024e-6)
    high = 2.7620075879983367e-7 + r * 2.5100375832561234e-8
    return (1.0 + (r + s * (low + f * (mid + f * high)))) * power_of_two(k)


def log(x: float) -> float:
    """Natural logarithm of a positive normal number."""
    high = mantissa(x) > 1.4142135623730951
    e = exponent(x) + (1.0 if high else 0.0)
    f = mantissa(x) * (0.5 if high else 1.0) - 1.0
    z = f * f
    p = 1.01875663804580931796e-4 * f + 4.97494994976747001425e-1
    p = ((p * f + 4.70579119878881725854) * f + 1.44989225341610930846e1) * f + 1.79368678507819816313e1
    p = p * f + 7.70838733755885391666
    q = ((f + 1.12873587189167450590e1) * f + 4.52279145837532221105e1) * f + 8.29875266912776603211e1
    q = (q * f + 7.11544750618563894466e1) * f + 2.31251620126765340583e1
    y = f * (z * p / q) - e * 2.121944400546905827679e-4 - 0.5 * z
    return (f + y) + e * 0.693359375


def power(x: float, a: float) -> float:
    """x**a for x >= 0 (0 for x below 1e-300)."""
    return exp(a * log(max(x, 1e-300)))


def sin(x: float) -> float:
    """Sine; accurate for |x| below about 1e6."""
    k = (x * 0.3183098861837907 + _ROUND) - _ROUND
    return _half_wave(x, k, k)


def cos(x: float) -> float:
    """Cosine; accurate for |x| below about 1e6."""
    k = ((x * 0.3183098861837907 + 0.5) + _ROUND) - _ROUND
    return _half_wave(x, k - 0.5, k)


def _half_wave(x: float, turns: float, k: float) -> float:
    """(-1)**k sin(x - turns pi) for an argument between -pi/2 and pi/2; pi in three parts, the first two of 30 bits."""
    r = ((x - turns * 3.141592651605606) - turns * 1.9841871583270443e-9) - turns * 1.034036596358821e-18
    z = r * r
    f = z * z
    low = (-0.16666666666666666 + z * 0.008333333333333316) + f * (-1.9841269841254974e-4 + z * 2.7557319219163234e-6)
    high = (-2.5052107616996182e-8 + z * 1.6058977312464087e-10) + f * (
        -7.643970296798572e-13 + z * 2.7314447669863995e-15
    )
    s = r + r * z * (low + f * f * high)
    half = 0.5 * k
    return s if half == (half + _ROUND) - _ROUND else -s


def atan(x: float) -> float:
    """Inverse tangent."""
    t = abs(x)
    far = t > 2.414213562373095
    near = t <= 0.41421356237309503
    num = -1.0 if far else (t if near else t - 1.0)
    den = t if far else (1.0 if near else t + 1.0)
    offset = 1.5707963267948966 if far else (0.0 if near else 0.7853981633974483)
    a = num / den
    z = a * a
    p = (-8.750608600031904122785e-1 * z - 1.615753718733365076637e1) * z - 7.500855792314704667340e1
    p = (p * z - 1.228866684490136173410e2) * z - 6.485021904942025371773e1
    q = (z + 2.485846490142306297962e1) * z + 1.650270098316988542046e2
    q = ((q * z + 4.328810604912902668951e2) * z + 4.853903996359136964868e2) * z + 1.945506571482613964425e2
    r = offset + (a + a * z * p / q)
    return -r if x < 0.0 else r


def tanh(x: float) -> float:
    """Hyperbolic tangent, to 2e-16 absolute."""
    e = exp(-2.0 * abs(x))
    r = (1.0 - e) / (1.0 + e)
    return -r if x < 0.0 else r


def sign(x: float) -> float:
    """-1, 0 or 1."""
    return 1.0 if x > 0.0 else (-1.0 if x < 0.0 else 0.0)


def relaxation(a: float) -> float:
    """phi_1(-a) = (1 - exp(-a)) / a, the weight of an exponential step (Hochbruck and Ostermann 2010, Eq. 1.5)."""
    series = 1.0 - a * (0.5 - a * (1.0 / 6.0 - a * (1.0 / 24.0 - a * (1.0 / 120.0 - a * (1.0 / 720.0)))))
    small = abs(a) < 1e-2
    return series if small else (1.0 - exp(-a)) / (1.0 if small else a)


def damped(a: float) -> float:
    """`relaxation` with exp(-a) replaced by its Pade approximant 1 / (1 + a + a^2 / 2): equally stable, and cheaper."""
    return (1.0 + 0.5 * a) / (1.0 + a + 0.5 * a * a)
