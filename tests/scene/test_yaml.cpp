#include <catch2/catch.hpp>

#include "io/yaml_cursor.h"

using namespace lucerna;
using namespace lucerna::io;

namespace {

std::string first_complaint(const std::string& text, const YamlLimits& limits = {}) {
    Diagnostics diagnostics;
    try {
        parse_yaml(text, "a.yaml", diagnostics, limits);
        diagnostics.throw_if_any();
        return "";
    } catch (const InputError& error) {
        return error.diagnostics().front().text();
    }
}

}  // namespace

TEST_CASE("Nodes know their places", "[unit]") {
    Diagnostics diagnostics;
    const auto root = parse_yaml("a: 1\nb:\n  - {c: 'x y'}\n  -\n", "a.yaml", diagnostics);
    REQUIRE(diagnostics.empty());
    REQUIRE(root->keys.size() == 2);
    CHECK(root->keys[1].text == "b");
    CHECK(root->keys[1].line == 2);
    CHECK(root->keys[1].column == 1);
    const YamlNode& list = *root->items[1];
    REQUIRE(list.kind == YamlNode::Kind::sequence);
    const YamlNode& map = *list.items[0];
    CHECK(map.keys[0].column == 6);
    CHECK(map.items[0]->text == "x y");
    CHECK(map.items[0]->line == 3);
    CHECK(map.items[0]->column == 9);
    CHECK(list.items[1]->kind == YamlNode::Kind::null);
}

TEST_CASE("What is not a proper document is refused with its place", "[unit]") {
    CHECK(first_complaint("a: [1, 2\nb: 3\n") != "");
    CHECK(first_complaint("a: b: c\n").rfind("a.yaml:1:5: not valid YAML", 0) == 0);
    CHECK(first_complaint("") == "a.yaml: is empty; expected a YAML document");
    CHECK(first_complaint("a: 1\n---\nb: 2\n").find("a second YAML document") != std::string::npos);
    CHECK(first_complaint("a: 1\nb: 2\na: 3\n") ==
          "a.yaml:3:1: duplicate key 'a', first given in line 1");
    CHECK(first_complaint("{a: 1, b: {c: 1, d: 2, c: 3}}") ==
          "a.yaml:1:24: duplicate key 'c', first given in line 1");
    CHECK(first_complaint("? [1, 2]\n: 3\n") == "a.yaml:1:3: a key must be a word");
    CHECK(first_complaint("a: !!python/object x\n").find("has no meaning here") !=
          std::string::npos);
    CHECK(first_complaint("a: *nowhere\n") != "");
    CHECK(first_complaint("a: &x [*x]\n").find("inside its own anchor") != std::string::npos);
}

TEST_CASE("Aliases are unfolded, but only to the limit", "[unit]") {
    Diagnostics diagnostics;
    const auto root = parse_yaml("a: &x {b: 1}\nc: *x\n", "a.yaml", diagnostics);
    CHECK(root->items[1] == root->items[0]);

    std::string bomb = "a0: &a0 [x, x, x, x, x, x, x, x, x, x]\n";
    for (int i = 1; i < 12; ++i) {
        const std::string last = "*a" + std::to_string(i - 1);
        bomb += "a" + std::to_string(i) + ": &a" + std::to_string(i) + " [" + last;
        for (int k = 0; k < 9; ++k) bomb += ", " + last;
        bomb += "]\n";
    }
    CHECK(first_complaint(bomb).find("more than 1048576 entries") != std::string::npos);
    CHECK(first_complaint(std::string(100, '[')).find("nested deeper") != std::string::npos);
    CHECK(first_complaint(std::string(100000, '[')).find("nested deeper") != std::string::npos);
    CHECK(first_complaint("a: 1\n", {.bytes = 3}).find("has 5 bytes") != std::string::npos);
}

TEST_CASE("Complaints are collected, unknown keys with the nearest known one", "[unit]") {
    Diagnostics diagnostics;
    const std::string file = "a.yaml";
    const auto root = parse_yaml("radius: -1 mm\nheigth: 3 mm\nnames: [x]\n", file, diagnostics);
    YamlMap map(YamlCursor(*root, file, diagnostics));
    CHECK(std::isnan(read_value(map.required("radius"), dimension::length, Accept::positive)));
    CHECK(std::isnan(read_value(map.required("height"), dimension::length)));
    CHECK(std::isnan(read_value(map.optional("names"), dimension::length)));
    map.no_other_keys();
    REQUIRE(diagnostics.list().size() == 4);
    CHECK(diagnostics.list()[0].text() == "a.yaml:1:9: radius: '-1 mm' is negative");
    CHECK(diagnostics.list()[1].text() == "a.yaml:1:1: the key 'height' is missing");
    CHECK(diagnostics.list()[2].text() ==
          "a.yaml:3:8: names: found a list; expected a length such as \"10 mm\"");
    CHECK(diagnostics.list()[3].text() ==
          "a.yaml:2:1: unknown key 'heigth'; did you mean 'height'?");
}
