#!/usr/bin/env python3
"""Checks that each source includes the standard headers of the names that it uses.

check_includes.py [BUILD]: a header counts if the file names it, or a header of lull's own that the file includes, directly or by
others of ours: whatever a standard library brings along besides differs between versions. With BUILD, the folder of a
configured preset without unity builds, each header and source of it is also compiled by itself, by clang. Prints what is missing.
"""
import concurrent.futures
import functools
import json
import pathlib
import re
import shlex
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[1]
FOLDERS = ("renderer", "stopping", "tests", "scenes")
# Names of the standard library by header; several headers declare some names, and any of these will do.
NAMES = {
    "algorithm": r"std::(?:ranges::)?(?:sort|stable_sort|nth_element|partial_sort|max_element|min_element|minmax_element|minmax|clamp|"
                 r"copy_n|copy_if|copy|fill_n|fill|find_if_not|find_if|find|any_of|all_of|none_of|count_if|count|transform|"
                 r"lower_bound|upper_bound|equal_range|binary_search|reverse|rotate|replace|remove_if|unique|partition|"
                 r"stable_partition|is_sorted|max|min|equal|for_each|generate|set_difference|includes|shuffle|mismatch|search|"
                 r"adjacent_find|lexicographical_compare|starts_with|ends_with)\b(?=\s*[(<])",
    "array": r"std::(?:array|to_array)\b",
    "atomic": r"std::(?:atomic(?:_\w+)?|memory_order\w*)\b",
    "bit": r"std::(?:bit_cast|bit_width|bit_floor|bit_ceil|popcount|countl_zero|countr_zero|has_single_bit|rotl|endian)\b",
    "cassert": r"\bassert\s*\(",
    "cerrno": r"\b(?:errno|E(?:NOENT|ACCES|INTR|EXIST|INVAL|NOSPC|PIPE|AGAIN|ISDIR|NOTDIR|RANGE))\b",
    "charconv": r"std::(?:from_chars|to_chars|chars_format)\b",
    "chrono": r"std::chrono\b",
    "cmath": r"std::(?:sqrt|abs|fabs|sin|cos|tan|asin|acos|atan2?|exp2?|expm1|log2?|log10|log1p|pow|floor|ceil|round|lround|trunc|"
             r"fmod|hypot|isnan|isfinite|isinf|cbrt|copysign|signbit|fma|erf|erfc|sinh|cosh|tanh|atanh|nextafter|ldexp|frexp|lgamma|"
             r"tgamma|remainder|fmin|fmax|ilogb|modf|nearbyint|rint|llround)\b",
    "complex": r"std::complex\b",
    "condition_variable": r"std::condition_variable\b",
    "csignal": r"std::(?:signal|raise|sig_atomic_t)\b|\bSIG(?:INT|TERM|KILL|SEGV|HUP|STOP)\b",
    "cstddef": r"std::(?:byte|ptrdiff_t|nullptr_t|max_align_t)\b|\boffsetof\b",
    "cstdint": r"\b(?:u?int(?:8|16|32|64)_t|u?intptr_t|U?INT(?:8|16|32|64)_(?:MAX|MIN))\b",
    "cstdio": r"std::(?:printf|fprintf|snprintf|fopen|fclose|fread|fwrite|fflush|fseek|fputs|puts|FILE|rename|remove\(|perror|getc|fgetc)\b",
    "cstdlib": r"std::(?:getenv|strtod|strtof|strtol|strtoul|strtoull|strtoll|exit|abort|atoi|atof|malloc|free|system|_Exit|quick_exit)\b"
               r"|\bEXIT_(?:SUCCESS|FAILURE)\b",
    "cstring": r"std::(?:memcpy|memcmp|memset|memmove|memchr|strlen|strcmp|strncmp|strerror|strchr|strrchr|strstr)\b",
    "ctime": r"std::(?:time_t|tm|strftime|localtime|gmtime|time)\b",
    "deque": r"std::deque\b",
    "exception": r"std::(?:exception|exception_ptr|current_exception|rethrow_exception|terminate|uncaught_exceptions)\b",
    "filesystem": r"std::filesystem\b",
    "fstream": r"std::(?:ifstream|ofstream|fstream|filebuf)\b",
    "functional": r"std::(?:function|hash|less|greater|plus|multiplies|reference_wrapper|cref|bind|identity|ranges::less|ranges::greater|"
                  r"equal_to|not_fn|invoke)\b(?!_)",
    "future": r"std::(?:future|promise|async|packaged_task|shared_future)\b",
    "initializer_list": r"std::initializer_list\b",
    "iomanip": r"std::(?:setprecision|setw|setfill|quoted|put_time|get_time)\b",
    "iostream": r"std::(?:cout|cerr|cin|clog)\b",
    "iterator": r"std::(?:back_inserter|istreambuf_iterator|istream_iterator|ostream_iterator|ostreambuf_iterator|move_iterator|"
                r"make_move_iterator|inserter|reverse_iterator|forward_iterator|input_iterator)\b",
    "limits": r"std::numeric_limits\b",
    "list": r"std::list\b",
    "map": r"std::(?:multi)?map\b",
    "memory": r"std::(?:unique_ptr|make_unique|shared_ptr|make_shared|weak_ptr|addressof|enable_shared_from_this|construct_at|destroy_at)\b",
    "mutex": r"std::(?:mutex|recursive_mutex|lock_guard|unique_lock|scoped_lock|once_flag|call_once)\b",
    "numbers": r"std::numbers\b",
    "numeric": r"std::(?:accumulate|iota|partial_sum|inner_product|reduce|gcd|lcm|midpoint|exclusive_scan|inclusive_scan|transform_reduce|"
               r"adjacent_difference)\b",
    "optional": r"std::(?:optional|nullopt|nullopt_t|make_optional)\b",
    "queue": r"std::(?:queue|priority_queue)\b",
    "random": r"std::(?:mt19937(?:_64)?|uniform_real_distribution|uniform_int_distribution|normal_distribution|random_device|"
              r"exponential_distribution|poisson_distribution|minstd_rand0?|bernoulli_distribution|lognormal_distribution|"
              r"geometric_distribution|discrete_distribution)\b",
    "regex": r"std::(?:regex|smatch|cmatch|regex_match|regex_search|regex_replace|sregex_iterator)\b",
    "set": r"std::(?:multi)?set\b",
    "span": r"std::(?:span|as_bytes|as_writable_bytes|dynamic_extent)\b",
    "sstream": r"std::(?:istringstream|ostringstream|stringstream|stringbuf)\b",
    "stdexcept": r"std::(?:runtime_error|logic_error|invalid_argument|out_of_range|domain_error|length_error|overflow_error|range_error)\b",
    "string": r"std::(?:string|to_string|stoi|stod|stof|stoul|stoull|stol|stoll|getline|u16string|u32string|u8string|wstring)\b",
    "string_view": r"std::string_view\b",
    "system_error": r"std::(?:error_code|system_error|errc|generic_category|system_category|make_error_code)\b",
    "thread": r"std::(?:thread|jthread|this_thread)\b",
    "tuple": r"std::(?:tuple|make_tuple|tie|apply|tuple_size\w*|tuple_element\w*|forward_as_tuple|ignore)\b",
    "type_traits": r"std::(?:is_same\w*|is_base_of\w*|enable_if\w*|decay\w*|remove_cv\w*|remove_reference\w*|remove_cvref\w*|conditional\w*|"
                   r"is_floating_point\w*|is_integral\w*|is_arithmetic\w*|is_trivially_\w+|is_const\w*|is_invocable\w*|invoke_result\w*|"
                   r"underlying_type\w*|is_enum\w*|make_unsigned\w*|make_signed\w*|is_convertible\w*|is_constructible\w*|is_void\w*|"
                   r"is_constant_evaluated|true_type|false_type|integral_constant|bool_constant|void_t|type_identity\w*|is_aggregate\w*|"
                   r"is_signed\w*|is_unsigned\w*|is_default_constructible\w*|is_nothrow_\w+)\b",
    "typeinfo": r"\btypeid\b",
    "unordered_map": r"std::unordered_(?:multi)?map\b",
    "unordered_set": r"std::unordered_(?:multi)?set\b",
    "utility": r"std::(?:move|forward|pair|make_pair|exchange|swap|declval|index_sequence\w*|make_index_sequence|integer_sequence|in_place\w*|"
               r"cmp_\w+|to_underlying|as_const|unreachable)\b",
    "variant": r"std::(?:variant|visit|get_if|holds_alternative|monostate|variant_size\w*|variant_alternative\w*)\b",
    "vector": r"std::vector\b",
}
# Headers that the standard says declare the names of another too, as far as those are used here.
ALSO = {
    "string_view": {"string"}, "initializer_list": {"vector", "string", "map", "set", "array", "span", "algorithm", "unordered_map",
                                                    "utility", "optional", "variant", "memory", "deque"},
    "exception": {"stdexcept", "system_error"}, "iterator": {"vector", "string", "array", "map", "span"},
    "utility": {"map", "unordered_map", "tuple", "vector", "algorithm", "memory", "optional", "variant", "functional"},
    "cstddef": {"span"}, "mutex": {"condition_variable"}, "tuple": {"map"},
    "cmath": {"complex"}, "system_error": {"filesystem", "charconv", "cerrno"},
    "string": {"sstream", "filesystem", "fstream", "regex", "stdexcept", "system_error"},
    "type_traits": {"variant", "utility", "memory", "functional"},
}
C_NAMES = {"cmath": "math.h", "cstdint": "stdint.h", "cstddef": "stddef.h", "cstring": "string.h", "cstdio": "stdio.h",
           "cstdlib": "stdlib.h", "csignal": "signal.h", "ctime": "time.h", "cassert": "assert.h", "cerrno": "errno.h"}
COMPILED = {header: re.compile(names) for header, names in NAMES.items()}
NOT_CODE = re.compile(r'//[^\n]*|/\*.*?\*/|R"(\w*)\(.*?\)\1"|"(?:\\.|[^"\\\n])*"', re.S)
INCLUDE = re.compile(r'^\s*#\s*include\s*(<[^>]+>|"[^"]+")', re.M)


@functools.cache
def text(path):
    return path.read_text(encoding="utf-8")


@functools.cache
def included(path):
    """Returns the headers that a file names: of the system, and of ours as paths."""
    system, ours = set(), set()
    for name in INCLUDE.findall(text(path)):
        plain = name[1:-1]
        candidates = (ROOT / plain, path.parent / plain, ROOT / "renderer/embedding/include" / plain)
        found = next((c for c in candidates if c.is_file()), None)
        if found:
            ours.add(found.resolve())
        else:
            system.add(plain)
    return system, ours


def all_included(path):
    system, seen, todo = set(), set(), [path]
    while todo:
        file = todo.pop()
        if file not in seen:
            seen.add(file)
            named, ours = included(file)
            system |= named
            todo += ours
    return system


def missing(path):
    """Yields (line, name, header) for each header that a file lacks."""
    code = NOT_CODE.sub(lambda m: '""' + "\n" * m[0].count("\n"), text(path))
    there = all_included(path)
    for header, names in COMPILED.items():
        use = names.search(code)
        if use and not there & {header, C_NAMES.get(header, header), *ALSO.get(header, ())}:
            yield code.count("\n", 0, use.start()) + 1, use[0], header


def files():
    for folder in FOLDERS:
        yield from sorted(p for p in (ROOT / folder).rglob("*") if p.suffix in (".h", ".cpp"))


def alone(build):
    """Compiles each file by itself; yields the first error of each that fails."""
    commands = {pathlib.Path(c["file"]).resolve(): c for c in json.loads((build / "compile_commands.json").read_text())}
    if any("Unity" in str(f) for f in commands):
        raise SystemExit(f"{build} is a unity build; configure one without -DCMAKE_UNITY_BUILD=ON")

    def compile_one(path, command):
        words = [w for w in shlex.split(command["command"]) if not w.startswith(("-march", "--param", "-Werror", "-fno-trapping"))]
        words = words[words.index(next(w for w in words if w.endswith(("c++", "g++", "cc", "gcc", "clang", "clang++")))) + 1:]
        words = words[:words.index("-o")]
        result = subprocess.run(["clang++", *words, "-w", "-fsyntax-only", "-x", "c++", str(path)], cwd=command["directory"], text=True,
                                stderr=subprocess.PIPE, check=False)
        error = re.search(r".*error: .*", result.stderr)
        return error[0] if error else f"{path}: clang++ failed" if result.returncode else None

    jobs = {path: c for path, c in commands.items() if path.suffix == ".cpp" and path.is_relative_to(ROOT) and "build" not in
            path.relative_to(ROOT).parts}
    for header in files():
        # As a source of the nearest folder is compiled.
        folder = header.parent
        while header.suffix == ".h" and header not in jobs and folder != ROOT:
            source = next((p for p in commands if p.is_relative_to(folder) and p.suffix == ".cpp"), None)
            if source:
                jobs[header] = commands[source]
            folder = folder.parent
    with concurrent.futures.ThreadPoolExecutor() as pool:
        yield from filter(None, pool.map(compile_one, *zip(*jobs.items())))


def main():
    if len(sys.argv) > 2:
        raise SystemExit(__doc__)
    errors = [f"{path.relative_to(ROOT)}:{line}: {name} needs <{header}>" for path in files() for line, name, header in missing(path)]
    if len(sys.argv) == 2:
        errors += alone(pathlib.Path(sys.argv[1]))
    print("\n".join(errors) or "Each file includes what it uses")
    raise SystemExit(1 if errors else 0)


if __name__ == "__main__":
    main()
