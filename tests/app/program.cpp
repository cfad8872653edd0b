#include "program.hpp"

#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <system_error>

#include <fcntl.h>
#include <linux/capability.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

namespace sandlane::test {

namespace {

// The write end goes to the child, unless the stream goes to a file.
struct Stream {
    int read_end = -1, write_end = -1;

    explicit Stream(const fs::path& file) {
        int ends[2] = {-1, -1};
        if (file.empty() && ::pipe2(ends, O_CLOEXEC) != 0)
            throw std::system_error(errno, std::generic_category());
        read_end = ends[0];
        write_end = file.empty() ? ends[1] : ::open(file.c_str(), O_WRONLY | O_CLOEXEC);
    }
};

std::string drain(int& descriptor) {
    std::string text;
    char buffer[4096];
    for (ssize_t n = 0; descriptor >= 0 && (n = ::read(descriptor, buffer, sizeof buffer)) != 0;)
        if (n > 0)
            text.append(buffer, static_cast<std::size_t>(n));
        else if (errno != EINTR)
            break;
    if (descriptor >= 0) ::close(descriptor);
    descriptor = -1;
    return text;
}

// In the child.
[[noreturn]] void become_program(const fs::path& folder, const Call& call, int out, int err) {
    ::dup2(out, STDOUT_FILENO);
    ::dup2(err, STDERR_FILENO);
    if (::chdir(folder.c_str()) != 0) ::_exit(126);
    for (const char* name : {"SANDLANE_ISA", "SANDLANE_THREADS", "OMP_NUM_THREADS"}) ::unsetenv(name);
    ::setenv("OMP_WAIT_POLICY", "passive", 1); // more threads than cores must not spin
    for (const auto& [name, value] : call.environment) ::setenv(name.c_str(), value.c_str(), 1);
    const auto limit = [](__rlimit_resource what, rlim_t most) {
        const rlimit both{most, most};
        if (most != RLIM_INFINITY && ::setrlimit(what, &both) != 0) ::_exit(125);
    };
    limit(RLIMIT_FSIZE, call.largest_file);
    limit(RLIMIT_AS, call.memory);
    // What root may do beyond permissions is gone after exec().
    if (!call.everywhere && ::geteuid() == 0)
        for (const int capability : {CAP_DAC_OVERRIDE, CAP_DAC_READ_SEARCH})
            if (::prctl(PR_CAPBSET_DROP, capability, 0, 0, 0) != 0) ::_exit(125);
    std::vector<std::string> words = {SANDLANE_PROGRAM};
    words.insert(words.end(), call.arguments.begin(), call.arguments.end());
    std::vector<char*> argv;
    for (std::string& word : words) argv.push_back(word.data());
    argv.push_back(nullptr);
    ::execv(SANDLANE_PROGRAM, argv.data());
    ::_exit(127);
}

} // namespace

Process::Process(const fs::path& folder, const Call& call) {
    const Stream out(call.out), err(call.err);
    id_ = ::fork();
    if (id_ == 0) become_program(folder, call, out.write_end, err.write_end);
    ::close(out.write_end);
    ::close(err.write_end);
    out_ = out.read_end;
    err_ = err.read_end;
}

Process::~Process() {
    if (running()) send(SIGKILL);
    (void)wait();
}

void Process::send(int signal) const {
    if (id_ > 0) ::kill(id_, signal);
}

bool Process::running() {
    if (id_ > 0 && ::wait4(id_, &status_, WNOHANG, &usage_) == id_) id_ = -1;
    return id_ > 0;
}

// Neither stream ever fills its pipe while the other one is read.
Outcome Process::wait() {
    Outcome o;
    o.out = drain(out_);
    o.err = drain(err_);
    while (id_ > 0 && ::wait4(id_, &status_, 0, &usage_) < 0 && errno == EINTR) {
    }
    id_ = -1;
    o.code = WIFEXITED(status_) ? WEXITSTATUS(status_) : -1;
    o.signal = WIFSIGNALED(status_) ? WTERMSIG(status_) : 0;
    o.memory = 1024 * static_cast<double>(usage_.ru_maxrss);
    return o;
}

std::map<std::string, std::string> App::results(const std::string& out) const {
    const std::set<std::string> others{".lock", "summary.json", "report.html"};
    std::map<std::string, std::string> files;
    for (const auto& entry : fs::recursive_directory_iterator(path(out))) {
        const fs::path& file = entry.path();
        if (entry.is_regular_file() && !others.contains(file.filename()) && file.extension() != ".checkpoint")
            files[file.lexically_relative(path(out))] = read(file.lexically_relative(folder_));
    }
    return files;
}

App::App() {
    std::string name = (fs::temp_directory_path() / "sandlane-XXXXXX").string();
    if (::mkdtemp(name.data()) == nullptr) throw std::system_error(errno, std::generic_category(), name);
    folder_ = name;
}

App::~App() {
    std::error_code ignored;
    fs::remove_all(folder_, ignored);
}

std::set<std::string> App::listing() const {
    std::set<std::string> names;
    for (const auto& entry : fs::recursive_directory_iterator(folder_))
        names.insert(fs::relative(entry.path(), folder_).string());
    return names;
}

std::string App::latest_checkpoint(const std::string& out) const {
    std::string latest; // names have their step in twelve digits
    for (const std::string& name : listing())
        if (name.starts_with(out + "/") && name.ends_with(".checkpoint")) latest = name;
    return latest;
}

Outcome App::run(const Call& call) const {
    Process process(folder_, call);
    return process.wait();
}

Outcome App::run_well(std::vector<std::string> arguments) const {
    Outcome o = run(std::move(arguments));
    EXPECT_EQ(o.code, 0) << o.err;
    return o;
}

const std::string box_scene = R"(title = "Box of glass"

[domain]
lower = [0, 0]
upper = ["80 mm", "80 mm"]
gravity = [0, -9.81]

[[materials]]
name = "glass"
density = 2500
young = "10 MPa"
dissipation = "50 us"
friction = 0.5
tangential_damping = "0.1 kg/s"

[[grains]]
kind = "lattice"
radius = { law = "uniform", min = "2 mm", max = "2.5 mm" }
lower = ["10 mm", "10 mm"]
counts = [10, 8]
spacing = ["6 mm", "6 mm"]
jitter = 0.05

[[walls]]
name = "box"
kind = "polyline"
closed = true
points = [[0.005, 0.005], [0.075, 0.005], [0.075, 0.075], [0.005, 0.075]]

[md]
duration = "0.2 s"

[output]
trajectory = ["dump", "book"]
picture_every = "0.1 s"
picture_width = 64
movie = false
report = false
)";

const std::string cube_scene = R"([domain]
dimension = 3
lower = [0, 0, 0]
upper = ["40 mm", "40 mm", "40 mm"]
gravity = [0, 0, -9.81]

[[materials]]
name = "glass"
young = "10 MPa"
dissipation = "50 us"
friction = 0.5
tangential_damping = "0.1 kg/s"

[[grains]]
kind = "lattice"
radius = "4 mm"
lower = ["8 mm", "8 mm", "3.9 mm"]
counts = [3, 3, 3]
spacing = ["8 mm", "8 mm", "8 mm"]
velocity = [0.1, 0.2, -0.5]

[[walls]]
name = "floor"
kind = "plane"
points = [[0, 0, 0]]
normal = [0, 0, 1]

[md]
duration = "2 ms"

[output]
picture_width = 64
movie = false
)";

std::string replaced(std::string text, const std::string& piece, const std::string& by) {
    const std::size_t at = text.find(piece);
    EXPECT_NE(at, std::string::npos) << piece;
    return at == std::string::npos ? text : text.replace(at, piece.size(), by);
}

} // namespace sandlane::test
