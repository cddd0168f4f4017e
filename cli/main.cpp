// lucerna: the command line. All errors end here, with an exit code and a text on stderr.
#include <fmt/format.h>

#ifdef __GLIBC__
#include <malloc.h>
#endif

#include <CLI/CLI.hpp>
#include <limits>
#include <map>
#include <new>
#include <stdexcept>

#include "cli/commands.h"
#include "core/diagnostics.h"
#include "io/quantity.h"
#include "io/setting_names.h"

using namespace lucerna;

namespace {

// Hands a number with unit, such as 2% or 60s, to an optional value.
std::function<void(const std::string&)> quantity_into(std::optional<double>& value,
                                                      const io::Dimension& dimension) {
    return [&value, &dimension](const std::string& text) {
        try {
            value = io::parse_value(text, dimension);
        } catch (const std::invalid_argument& error) {  // CLI11 wants a type of its own
            throw CLI::ValidationError(error.what());
        }
        if (!(*value > 0.0))
            throw CLI::ValidationError(fmt::format("'{}' is not above zero", text));
    };
}

struct CommandLine {
    CLI::App app{"Lucerna: spectral simulation of light with accuracy bounds", "lucerna"};
    cli::RunOptions run;
    std::filesystem::path scene_to_check, photometric_file;
    cli::CompareOptions compare;
    cli::MergeOptions merge;
    cli::BenchOptions bench;
    CLI::App* run_command;
    CLI::App* check_command;
    CLI::App* compare_command;
    CLI::App* merge_command;
    CLI::App* photometry_command;
    CLI::App* bench_command;
    CLI::App* validate_command;
    cli::ValidateOptions validate;

    CommandLine() {
        app.set_version_flag("--version", "lucerna " LUCERNA_VERSION);
        app.require_subcommand(0,
                               1);  // with none of these, an unknown word is named in the complaint

        run_command =
            app.add_subcommand("run", "Simulate a scene; write images, previews and report");
        run_command->add_option("SCENE", run.scene, "Scene file (YAML)")->required();
        run_command->add_option("-o,--output", run.output,
                                "Folder of the results [SCENE-results beside the scene]");
        run_command
            ->add_option_function(
                "--accuracy", quantity_into(run.accuracy, io::dimension::percent),
                "Stop at this noise of images and uncertainty of sensors, such as 2%")
            ->type_name("PERCENT");
        run_command
            ->add_option_function("--time", quantity_into(run.time_limit_s, io::dimension::time),
                                  "Wall time to stop at, such as 60s or 10min")
            ->type_name("TIME");
        run_command->add_option("--phases", run.phases, "Number of phases to stop at")
            ->check(CLI::PositiveNumber);
        run_command->add_option("--threads", run.threads, "Threads to use [all of the machine]")
            ->check(CLI::PositiveNumber);
        CLI::Option* seed =
            run_command->add_option("--seed", run.seed, "Seed of the random numbers")
                ->check(CLI::NonNegativeNumber);
        CLI::Option* method = run_command->add_option("--method", run.method, "Estimators to use")
                                  ->transform(CLI::CheckedTransformer(io::methods()));
        CLI::Option* scheduler =
            run_command
                ->add_option(
                    "--scheduler", run.scheduler,
                    "How threads share the work; synchronous and two-level do not give the "
                    "same bits twice [ordered]")
                ->transform(CLI::CheckedTransformer(io::schedulers()));
        CLI::Option* spectral = run_command
                                    ->add_option("--spectral", run.spectral_bins,
                                                 "Bins of the spectral image [0: none]")
                                    ->check(CLI::Range(0, 470));  // 1 nm over 360 to 830 nm
        run_command
            ->add_flag("--resume", run.resume,
                       "Go on with the run whose results are in the folder; --time counts from "
                       "now, --phases from its start")
            ->excludes(seed)
            ->excludes(method)
            ->excludes(scheduler)
            ->excludes(spectral);

        merge_command =
            app.add_subcommand("merge", "Join runs of a scene that have different seeds");
        merge_command->add_option("RESULTS", merge.results, "Folders of results, two at least")
            ->required()
            ->expected(2, -1);
        merge_command->add_option("-o,--output", merge.output, "Folder of the joined results")
            ->required();
        merge_command->add_option("--scene", merge.scene, "Scene file [where the runs found it]");

        check_command = app.add_subcommand("check", "Read a scene and say what it holds");
        check_command->add_option("SCENE", scene_to_check, "Scene file (YAML)")->required();

        compare_command = app.add_subcommand("compare", "Say how far an image is from a reference");
        compare_command->add_option("REF", compare.reference, "Reference (EXR or PFM)")->required();
        compare_command->add_option("IMAGE", compare.image, "Image of the same size")->required();
        compare_command
            ->add_option("--scale", compare.scale,
                         "Luminance of IMAGE that stands for 1 in REF [1]")
            ->check(CLI::PositiveNumber);
        compare_command->add_option("--mask", compare.mask,
                                    "Image whose pixels of value 0 do not count");

        bench_command = app.add_subcommand("bench", "Say how fast scenes are simulated, and why");
        bench_command->add_option("SCENE", bench.scenes, "Scene files (YAML)")->required();
        bench_command->add_option("-o,--output", bench.output, "JSON file of the numbers [none]");
        bench_command
            ->add_option("--paths", bench.paths, "Paths of each kind, for the rates [100000]")
            ->check(CLI::PositiveNumber);
        bench_command
            ->add_option("--repetitions", bench.repetitions, "Repetitions of all that is timed [3]")
            ->check(CLI::PositiveNumber);
        bench_command
            ->add_option("--phases", bench.phases, "Phases of each run [4, with --delta no limit]")
            ->check(CLI::PositiveNumber);
        bench_command
            ->add_option("--threads", bench.threads,
                         "Numbers of threads to compare, such as 1,2,4 [all of the machine]")
            ->delimiter(',')
            ->allow_extra_args(false)
            ->check(CLI::PositiveNumber);
        bench_command
            ->add_option("--method", bench.methods,
                         "Estimators to compare, such as combined,forward [those of the scene]")
            ->delimiter(',')
            ->allow_extra_args(false)
            ->transform(CLI::CheckedTransformer(io::methods()));
        bench_command
            ->add_option("--scheduler", bench.schedulers,
                         "Ways of sharing the work among threads to compare [ordered]")
            ->delimiter(',')
            ->allow_extra_args(false)
            ->transform(CLI::CheckedTransformer(io::schedulers()));
        CLI::Option* delta =
            bench_command
                ->add_option_function("--delta", quantity_into(bench.delta, io::dimension::percent),
                                      "Stop each run at this noise of images, such as 5%")
                ->type_name("PERCENT");
        bench_command
            ->add_option_function("--time-limit",
                                  quantity_into(bench.time_limit_s, io::dimension::time),
                                  "Wall time to stop each run at before that [60s]")
            ->type_name("TIME")
            ->needs(delta);

        validate_command = app.add_subcommand(
            "validate", "Compare the engine with truths that were derived without it");
        validate_command->add_option("CASE", validate.cases,
                                     "Cases: ids, families, or patterns such as 'furnace/*' [all]");
        validate_command->add_flag("--list", validate.list, "Only say which cases there are");
        validate_command
            ->add_option("--draw", validate.draw,
                         "Cases to draw per family, by the seed, in place of the fixed ones")
            ->check(CLI::PositiveNumber);
        validate_command->add_option("--seeds", validate.seeds, "Runs per case, for coverage [1]")
            ->check(CLI::PositiveNumber);
        validate_command->add_option("--seed", validate.seed, "Seed of the first run [1]")
            ->check(CLI::NonNegativeNumber);
        validate_command
            ->add_option("--threads", validate.threads, "Runs at once [all of the machine]")
            ->check(CLI::PositiveNumber);
        validate_command
            ->add_option_function("--accuracy",
                                  quantity_into(validate.accuracy, io::dimension::percent),
                                  "Stop each run at this uncertainty [a fixed effort per case]")
            ->type_name("PERCENT");
        validate_command
            ->add_option(
                "--phases", validate.phases,
                "Phases of each run, or with --accuracy the most of them [those of the case]")
            ->check(CLI::PositiveNumber);
        validate_command->add_option("--method", validate.method, "Estimators [those of the case]")
            ->transform(CLI::CheckedTransformer(io::methods()));
        validate_command->add_option("-o,--output", validate.output,
                                     "Folder of validation.json and validation.html [none]");

        photometry_command =
            app.add_subcommand("photometry", "Say what an IES or EULUMDAT file holds");
        photometry_command->add_option("FILE", photometric_file, "IES LM-63 or EULUMDAT file")
            ->required();
    }

    cli::ExitCode execute() const {
        if (*run_command) return cli::run(run);
        if (*check_command) return cli::check(scene_to_check);
        if (*compare_command) return cli::compare(compare);
        if (*merge_command) return cli::merge(merge);
        if (*bench_command) return cli::bench(bench);
        if (*validate_command) return cli::validate(validate);
        if (*photometry_command) return cli::photometry(photometric_file);
        fmt::print(stderr, "{}", app.help());
        return cli::bad_input;
    }
};

void complain(const std::string& message) {
    fmt::print(stderr, "{}\n", message);
}

// The maps of a phase are as large as those of the one before. glibc hands large blocks back to the
// system and fetches them again page by page, which takes up to half of the time; here it keeps
// them.
void keep_freed_memory() {
#ifdef __GLIBC__
    mallopt(M_MMAP_MAX, 0);
    mallopt(M_TRIM_THRESHOLD, std::numeric_limits<int>::max());
    mallopt(M_TOP_PAD, 64 << 20);
#endif
}

}  // namespace

int main(int argc, char** argv) {
    keep_freed_memory();
    CommandLine command_line;
    try {
        command_line.app.parse(argc, argv);
        return command_line.execute();
    } catch (const CLI::ParseError& error) {  // also --help and --version, with code 0
        return command_line.app.exit(error) == 0 ? cli::done : cli::bad_input;
    } catch (const InputError& error) {
        complain(error.what());
        return cli::bad_input;
    } catch (const std::bad_alloc&) {
        complain("lucerna: the memory of the machine does not suffice");
        return cli::internal_error;
    } catch (const std::exception& error) {
        complain(fmt::format("lucerna: {}", error.what()));
        return cli::internal_error;
    }
}
