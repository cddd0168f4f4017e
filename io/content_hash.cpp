#include "io/content_hash.h"

#include <array>
#include <bit>
#include <cstdint>
#include <fstream>
#include <iterator>

#include "core/diagnostics.h"

namespace lucerna::io {
namespace {

using Word = std::uint32_t;

// The first 32 bits of the fractional part of a root of the n-th prime (FIPS 180-4, 4.2.2
// and 5.3.3), found in integers: the largest r with r^power <= prime * 2^(32 power), taken modulo
// 2^32.
constexpr Word root_fraction(unsigned prime, int power) {
    __extension__ using Wide = unsigned __int128;
    std::uint64_t root = 0;
    for (int bit = 35; bit >= 0; --bit) {
        const std::uint64_t trial = root | std::uint64_t{1} << bit;
        // trial < 2^36: the cube fits in 108 bits, and prime * 2^96 in 105 bits.
        const Wide value = power == 2 ? Wide{trial} * trial : Wide{trial} * trial * trial;
        if (value <= Wide{prime} << (32 * power)) root = trial;
    }
    return static_cast<Word>(root);
}

template <std::size_t count>
constexpr std::array<Word, count> prime_root_fractions(int power) {
    std::array<Word, count> words{};
    std::size_t found = 0;
    for (unsigned n = 2; found < count; ++n) {
        bool prime = true;
        for (unsigned d = 2; d * d <= n; ++d) prime = prime && n % d != 0;
        if (prime) words[found++] = root_fraction(n, power);
    }
    return words;
}

constexpr std::array<Word, 64> round_constants = prime_root_fractions<64>(3);
constexpr std::array<Word, 8> initial_state = prime_root_fractions<8>(2);

// FIPS 180-4, section 6.2.2, steps 1 to 4 for one block of 64 bytes.
void add_block(std::array<Word, 8>& state, const unsigned char* block) {
    std::array<Word, 64> w;
    for (std::size_t t = 0; t < 16; ++t) {
        w[t] = Word{block[4 * t]} << 24 | Word{block[4 * t + 1]} << 16 |
               Word{block[4 * t + 2]} << 8 | Word{block[4 * t + 3]};
    }
    for (std::size_t t = 16; t < 64; ++t) {
        const Word s0 = std::rotr(w[t - 15], 7) ^ std::rotr(w[t - 15], 18) ^ w[t - 15] >> 3;
        const Word s1 = std::rotr(w[t - 2], 17) ^ std::rotr(w[t - 2], 19) ^ w[t - 2] >> 10;
        w[t] = s1 + w[t - 7] + s0 + w[t - 16];
    }
    auto [a, b, c, d, e, f, g, h] = state;
    for (std::size_t t = 0; t < 64; ++t) {
        const Word sum1 = std::rotr(e, 6) ^ std::rotr(e, 11) ^ std::rotr(e, 25);
        const Word choice = (e & f) ^ (~e & g);
        const Word t1 = h + sum1 + choice + round_constants[t] + w[t];
        const Word sum0 = std::rotr(a, 2) ^ std::rotr(a, 13) ^ std::rotr(a, 22);
        const Word majority = (a & b) ^ (a & c) ^ (b & c);
        h = g;
        g = f;
        f = e;
        e = d + t1;
        d = c;
        c = b;
        b = a;
        a = t1 + sum0 + majority;
    }
    const std::array<Word, 8> change = {a, b, c, d, e, f, g, h};
    for (std::size_t i = 0; i < 8; ++i) state[i] += change[i];
}

}  // namespace

std::string sha256(std::string_view bytes) {
    std::string padded(bytes);  // section 5.1.1: a 1 bit, zeros, the length in bits
    padded += '\x80';
    padded.append((120 - padded.size() % 64) % 64, '\0');
    for (int shift = 56; shift >= 0; shift -= 8) {
        padded += static_cast<char>(std::uint64_t{bytes.size()} * 8 >> shift);
    }
    std::array<Word, 8> state = initial_state;
    for (std::size_t at = 0; at < padded.size(); at += 64) {
        add_block(state, reinterpret_cast<const unsigned char*>(padded.data()) + at);
    }
    std::string digits;
    for (const Word word : state) digits += fmt::format("{:08x}", word);
    return digits;
}

std::string content_hash(std::span<const std::filesystem::path> files) {
    std::string list;
    for (const auto& path : files) {
        std::ifstream file(path, std::ios::binary);
        const std::string bytes{std::istreambuf_iterator<char>(file), {}};
        if (!file.is_open() || file.bad()) throw InputError({path.string()}, "cannot be read");
        list += sha256(bytes) + "\n";
    }
    return sha256(list);
}

}  // namespace lucerna::io
