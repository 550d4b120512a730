"""Names that C99 and C++ accept."""

import re

_C = """auto break case char const continue default do double else enum extern float for goto if inline int long
register restrict return short signed sizeof static struct switch typedef union unsigned void volatile while"""
_CPP = """alignas alignof and and_eq asm bitand bitor bool catch char16_t char32_t class compl concept const_cast
constexpr decltype delete dynamic_cast explicit export false friend mutable namespace new noexcept not not_eq nullptr
operator or or_eq private protected public reinterpret_cast requires static_assert static_cast template this
thread_local throw true try typeid typename using virtual wchar_t xor xor_eq"""
_MACROS = """NAN INFINITY HUGE_VAL NULL NDEBUG errno linux unix i386 isnan isinf isfinite isnormal signbit fpclassify
isgreater isless isunordered math_errhandling MATH_ERRNO MATH_ERREXCEPT"""
_LIBRARY = """acosh asin acos asinh atan2 atanh cbrt ceil copysign cosh erf erfc expm1 fabs floor fmod hypot lgamma
log10 log1p log2 pow rint sinh sqrt tan tgamma trunc memcpy"""
_FILES = {"all", "fmi2", "fmi3", "kernel", "machine", "unit", "variables"}  # names of an FMU's own files and functions
_OURS = "p dt rates"  # what the written functions call their own
_TAKEN = {*_C.split(), *_CPP.split(), *_MACROS.split(), *_LIBRARY.split(), *_OURS.split()}


def identifier(name: str) -> str:
    """`name` as one identifier: what is no ASCII letter, digit or _ becomes _uXXXX, taken words get a _ at the end."""
    plain = "".join(c if re.fullmatch(r"[A-Za-z0-9_]", c) else f"_u{ord(c):04x}" for c in name)
    if plain in _TAKEN or plain.startswith("kernel_") or plain.endswith("_"):  # so that no two names become one
        plain += "_"
    return plain


def prefix_of(name: str) -> str:
    """The prefix of all names of an exported machine, from the name of its machine file."""
    plain = re.sub(r"[^A-Za-z0-9]+", "_", name).strip("_") or "machine"
    if plain.lower() in _FILES:
        return f"{plain}_model"
    return plain if plain[0].isalpha() else f"machine_{plain}"


def comment(text: str) -> str:
    """`text` without what would end or open a comment."""
    return " ".join(text.replace("*/", "* /").replace("/*", "/ *").split())
