#include <catch2/catch.hpp>

#include "core/diagnostics.h"
#include "io/atomic_file.h"
#include "io/content_hash.h"
#include "tests/io/example_result.h"

using namespace lucerna;
using namespace lucerna::io;

TEST_CASE("SHA-256 gives the published digests", "[unit][hash]") {
    // NIST, "Secure Hash Standard: example values" for FIPS 180-4, and the empty message of the
    // CAVP vectors.
    CHECK(sha256("") == "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
    CHECK(sha256("abc") == "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
    CHECK(sha256("abcdbcdecdefdefgefghfghighijhijkijkljklmklmnlmnomnopnopq") ==
          "248d6a61d20638b8e5c026930c3e6039a33ce45964ff2167f6ecedd419db06c1");
    CHECK(sha256(std::string(1'000'000, 'a')) ==
          "cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0");
}

TEST_CASE("The hash of a scene follows the contents and the order of its files, not their names",
          "[unit][hash]") {
    ScratchFolder folder;
    write_file(folder / "scene.yaml", "abc");
    write_file(folder / "lamp.ies", "");
    write_file(folder / "renamed.yaml", "abc");
    const std::string hash = content_hash(std::vector{folder / "scene.yaml", folder / "lamp.ies"});
    // printf 'SHA(abc)\nSHA()\n' | sha256sum, with the digests above
    CHECK(hash == sha256("ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad\n"
                         "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855\n"));
    CHECK(hash == content_hash(std::vector{folder / "renamed.yaml", folder / "lamp.ies"}));
    CHECK(hash != content_hash(std::vector{folder / "lamp.ies", folder / "scene.yaml"}));
    CHECK(hash != content_hash(std::vector{folder / "scene.yaml"}));
    CHECK_THROWS_AS(content_hash(std::vector{folder / "none"}), InputError);
}
