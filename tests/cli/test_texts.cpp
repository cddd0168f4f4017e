#include <catch2/catch.hpp>

#include "cli/progress_line.h"
#include "cli/results_folder.h"

using namespace lucerna;
using namespace lucerna::cli;

TEST_CASE("The progress line says what is known", "[cli]") {
    optics::Progress progress;
    progress.phase = 12;
    progress.delta = 0.031;
    progress.rays_per_s = 4.2e6;
    progress.elapsed_s = 12.3;
    CHECK(progress_text(progress) == "phase 12, noise 3.1 %, 4.20 M rays/s, 12 s");
    progress.delta_wanted = 0.02;
    progress.left_s = 17.2;
    CHECK(progress_text(progress) ==
          "phase 12, noise 3.1 % of 2 % wanted, 4.20 M rays/s, 12 s, 17 s left");
    progress.furthest = {"desk[3,1]", 1.42};
    CHECK(progress_text(progress) ==
          "phase 12, noise 3.1 % of 2 % wanted, U of desk[3,1] 1.4 times what is wanted, 4.20 M "
          "rays/s, 12 s, 17 s left");
    progress.furthest.excess = std::numeric_limits<double>::infinity();
    CHECK(progress_text(progress) ==
          "phase 12, noise 3.1 % of 2 % wanted, nothing known of desk[3,1] yet, 4.20 M rays/s, "
          "12 s, 17 s left");
    progress.furthest = {};
    progress.delta = std::numeric_limits<double>::quiet_NaN();
    CHECK(progress_text(progress) == "phase 12, 4.20 M rays/s, 12 s, 17 s left");
}

TEST_CASE("Durations are read at a glance", "[cli]") {
    CHECK(duration_text(0.4) == "0 s");
    CHECK(duration_text(59.7) == "1 min 00 s");
    CHECK(duration_text(185.0) == "3 min 05 s");
    CHECK(duration_text(7620.0) == "2 h 07 min");
}

TEST_CASE("Results lie beside the scene, in files named after the cameras", "[cli]") {
    CHECK(default_results_folder("rooms/office.yaml") == "rooms/office-results");
    CHECK(default_results_folder("office.yaml") == "office-results");
    std::vector<optics::Image> images(5);
    images[0].name = "from the door";
    images[1].name = "from/the/door";
    images[2].name = "../../etc/passwd";
    images[3].name = "Küche";
    CHECK(file_names(images) == std::vector<std::string>{"from_the_door", "from_the_door-2",
                                                         "______etc_passwd", "Küche", "image"});
}
