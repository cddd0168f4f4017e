#include "io/setting_names.h"

#include <algorithm>

namespace lucerna::io {
namespace {

template <typename Choice>
const std::string& key_of(const std::map<std::string, Choice>& choices, Choice choice) {
    return std::find_if(choices.begin(), choices.end(),
                        [&](const auto& entry) { return entry.second == choice; })
        ->first;
}

}  // namespace

const std::map<std::string, optics::Method>& methods() {
    static const std::map<std::string, optics::Method> all{{"automatic", optics::Method::automatic},
                                                           {"combined", optics::Method::combined},
                                                           {"forward", optics::Method::forward},
                                                           {"backward", optics::Method::backward},
                                                           {"path", optics::Method::path}};
    return all;
}

const std::map<std::string, optics::Scheduler>& schedulers() {
    static const std::map<std::string, optics::Scheduler> all{
        {"ordered", optics::Scheduler::ordered},
        {"synchronous", optics::Scheduler::synchronous},
        {"asynchronous", optics::Scheduler::asynchronous},
        {"two-level", optics::Scheduler::two_level}};
    return all;
}

const std::string& name_of(optics::Method method) {
    return key_of(methods(), method);
}

const std::string& name_of(optics::Scheduler scheduler) {
    return key_of(schedulers(), scheduler);
}

}  // namespace lucerna::io
