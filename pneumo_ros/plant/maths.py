"""Elementary functions for the equations of effects, written so that one text serves three readers.

The same source runs in pure Python, compiles to scalar machine code and vectorises over lanes: no branch that LLVM
cannot turn into a select, no call into libm. Hence compiled and interpreted results agree to the last bit. Rational
approximations and range reductions are those of the Cephes library (S. L. Moshier, 1989), accurate to about 2e-16
relative; the exponential is a minimax polynomial of degree 11, 8.5e-18 relative, because a division would wait longer
than the multiplications of Estrin's scheme.
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
    low = (0.4999999999999999 + r * 0.16666666666666616) + s * (0.04166666666669605 + r * 0.00833333333350833)
    mid = (1.388888887251106e-3 + r * 1.984126872704277e-4) + s * (2.4801608506941774e-5 + r * 2.755955529205422e-6)
    high = 2.756824727392381e-7 + r * 2.3704436644330245e-8
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
    """Sine; accurate for |x| below about 1e5."""
    k = (x * 0.3183098861837907 + _ROUND) - _ROUND
    r = ((x - k * 3.140625) - k * 9.67502593994140625e-4) - k * 1.509957990978376432e-7
    z = r * r
    p = (1.58962301576546568060e-10 * z - 2.50507477628578072866e-8) * z + 2.75573136213857245213e-6
    p = ((p * z - 1.98412698295895385996e-4) * z + 8.33333333332211858878e-3) * z - 1.66666666666666307295e-1
    s = r + r * z * p
    half = 0.5 * k
    return s if half == (half + _ROUND) - _ROUND else -s


def cos(x: float) -> float:
    """Cosine; accurate for |x| below about 1e5."""
    return sin(x + 1.5707963267948966)


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
    """`relaxation` with exp(-a) replaced by its Pade approximant 1 / (1 + a + a^2 / 2): as stable, and cheaper."""
    return (1.0 + 0.5 * a) / (1.0 + a + 0.5 * a * a)
