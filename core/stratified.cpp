#include "core/stratified.h"

#include <bit>

namespace lucerna {
namespace {

// Further pairs belong to events far from the origin, which no stratification reaches.
constexpr std::uint32_t stratified_pairs = 12;

std::uint32_t reversed_bits(std::uint32_t x) {
    x = __builtin_bswap32(x);
    x = ((x & 0xf0f0f0f0u) >> 4) | ((x & 0x0f0f0f0fu) << 4);
    x = ((x & 0xccccccccu) >> 2) | ((x & 0x33333333u) << 2);
    return ((x & 0xaaaaaaaau) >> 1) | ((x & 0x55555555u) << 1);
}

// A bijection that mixes all bits (constants of Wellons, "Prospecting for hash functions", 2018).
std::uint32_t hashed(std::uint32_t x) {
    x ^= x >> 16;
    x *= 0x7feb352du;
    x ^= x >> 15;
    x *= 0x846ca68bu;
    return x ^ (x >> 16);
}

// Owen's nested scrambling of the digits of x, most significant first; each digit is flipped or not
// by a hash of those before it (Burley, "Practical hash-based Owen scrambling", JCGT 9(4), 2020,
// sec. 3.2; the constants are those of its listing 1). The digits of `x` are given in reverse
// order.
std::uint32_t scrambled(std::uint32_t x, std::uint32_t key) {
    x += key;
    for (const std::uint32_t factor : {0x6c50b47cu, 0xb82f1e52u, 0xc7afe638u, 0x8d22f6e6u}) {
        x ^= x * factor;
    }
    return reversed_bits(x);
}

// Second dimension of Sobol's sequence, its digits in reverse order: the columns of Pascal's
// triangle modulo 2.
std::uint32_t second_dimension(std::uint32_t index) {
    std::uint32_t result = 0;
    for (std::uint32_t column = 1; index != 0; index >>= 1, column ^= column << 1) {
        result ^= index & 1u ? column : 0u;
    }
    return result;
}

}  // namespace

std::array<double, 2> StratifiedStream::pair() {
    if (stratum_.count == 1 || pairs_ >= stratified_pairs) {
        const double first = uniform();
        return {first, uniform()};
    }
    const std::uint32_t key = hashed(stratum_.set + hashed(pairs_++));
    // The order is scrambled as well, so that pairs of different dimensions are independent. Of the
    // whole sequence only the start is used: aligned parts of it are alike.
    const std::uint32_t length = std::bit_ceil(stratum_.count);
    const std::uint32_t index =
        scrambled(reversed_bits(stratum_.index), hashed(key ^ 1u)) & (length - 1);
    // The first dimension of the sequence is the index with its digits in reverse order.
    return {scrambled(index, hashed(key ^ 2u)) * 0x1p-32,
            scrambled(second_dimension(index), hashed(key ^ 3u)) * 0x1p-32};
}

}  // namespace lucerna
