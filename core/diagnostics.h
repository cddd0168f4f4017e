// Errors in what the user wrote. All errors of a file are collected and reported at once.
#pragma once

#include <stdexcept>
#include <string>
#include <vector>

namespace lucerna {

/// A place in an input file; line and column count from 1, 0 means unknown.
struct SourceLocation {
    std::string file;
    int line = 0;
    int column = 0;
};

/// One complaint about an input: where, and what was found and what would be accepted.
struct Diagnostic {
    SourceLocation where;
    std::string message;

    /// "room.yaml:14:12: message"; parts of the place that are unknown are left out.
    std::string text() const;
};

/// Thrown once a file has been read as far as possible; holds all that is wrong with it.
class InputError : public std::runtime_error {
public:
    explicit InputError(std::vector<Diagnostic> diagnostics);
    InputError(SourceLocation where, std::string message);

    const std::vector<Diagnostic>& diagnostics() const { return diagnostics_; }

private:
    std::vector<Diagnostic> diagnostics_;
};

/// Collects the complaints while a file is read.
class Diagnostics {
public:
    void add(SourceLocation where, std::string message) {
        list_.push_back({std::move(where), std::move(message)});
    }
    /// Takes over the complaints of a file that this one refers to.
    void add(const InputError& error) {
        list_.insert(list_.end(), error.diagnostics().begin(), error.diagnostics().end());
    }
    bool empty() const { return list_.empty(); }
    const std::vector<Diagnostic>& list() const { return list_; }
    /// Throws InputError if anything was collected.
    void throw_if_any() const {
        if (!list_.empty()) throw InputError(list_);
    }

private:
    std::vector<Diagnostic> list_;
};

/// The entry of `known` closest to `word` (edit distance), or "" if none is close.
std::string nearest_word(const std::string& word, const std::vector<std::string>& known);

}  // namespace lucerna
