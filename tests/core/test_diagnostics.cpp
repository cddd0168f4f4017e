#include "core/diagnostics.h"

#include <catch2/catch.hpp>

using namespace lucerna;

TEST_CASE("A diagnostic names its place as far as it is known", "[unit]") {
    CHECK((Diagnostic{{"room.yaml", 14, 12}, "no unit"}.text()) == "room.yaml:14:12: no unit");
    CHECK((Diagnostic{{"room.yaml", 14, 0}, "no unit"}.text()) == "room.yaml:14: no unit");
    CHECK((Diagnostic{{"room.yaml", 0, 12}, "no unit"}.text()) == "room.yaml: no unit");
    CHECK((Diagnostic{{}, "no unit"}.text()) == "no unit");
}

TEST_CASE("An input error holds all diagnostics and shows one per line", "[unit]") {
    Diagnostics diagnostics;
    CHECK(diagnostics.empty());
    CHECK_NOTHROW(diagnostics.throw_if_any());
    diagnostics.add({"a.yaml", 1, 2}, "first");
    diagnostics.add(InputError({"b.csv", 3, 4}, "second"));
    CHECK_FALSE(diagnostics.empty());
    try {
        diagnostics.throw_if_any();
        FAIL("nothing was thrown");
    } catch (const InputError& error) {
        REQUIRE(error.diagnostics().size() == 2);
        CHECK(error.diagnostics()[1].where.file == "b.csv");
        CHECK(std::string(error.what()) == "a.yaml:1:2: first\nb.csv:3:4: second");
    }
}

TEST_CASE("The nearest word is proposed if it is near", "[unit]") {
    const std::vector<std::string> known = {"reflectance", "roughness", "index", "n"};
    CHECK(nearest_word("reflectence", known) == "reflectance");
    CHECK(nearest_word("rougness", known) == "roughness");
    CHECK(nearest_word("indx", known) == "index");
    CHECK(nearest_word("index", known) == "index");
    CHECK(nearest_word("temperature", known).empty());
    CHECK(nearest_word("anything", {}).empty());
}
