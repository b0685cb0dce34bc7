#include "program.hpp"

#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <fstream>
#include <sstream>
#include <stdexcept>

#include "core/random.hpp"

namespace pelletlab::crosscode {

std::string find_program(const std::string& name) {
    const char* path = std::getenv("PATH");
    std::istringstream folders(path == nullptr ? "" : path);
    std::string folder;
    while (std::getline(folders, folder, ':')) {
        const std::string file = folder + "/" + name;
        if (!folder.empty() && access(file.c_str(), X_OK) == 0) return file;
    }
    return {};
}

Folder::Folder() {
    std::string name = (std::filesystem::temp_directory_path() / "pelletlab-XXXXXX").string();
    if (mkdtemp(name.data()) == nullptr) throw std::runtime_error("no temporary folder");
    path = name;
}

Folder::~Folder() {
    std::error_code ignored;
    std::filesystem::remove_all(path, ignored);
}

void Folder::write(const std::string& name, const std::string& content) const {
    std::filesystem::create_directories((path / name).parent_path());
    std::ofstream(path / name, std::ios::binary) << content;
}

void Folder::write(const std::vector<shapegen::formats::FormatFile>& files) const {
    for (const shapegen::formats::FormatFile& file : files) write(file.name, file.content);
}

std::string Folder::read(const std::string& name) const {
    std::ifstream file(path / name, std::ios::binary);
    std::ostringstream content;
    content << file.rdbuf();
    return content.str();
}

int Folder::run(const std::string& command) const {
    // Open MPI refuses to run as root without being told twice; that is how containers run.
    const std::string line = "cd '" + path.string() + "' && OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 OMP_NUM_THREADS=1 timeout 180 " +
                             command + " > output.txt 2>&1 < /dev/null";
    const int status = std::system(line.c_str());
    return WIFEXITED(status) ? WEXITSTATUS(status) : 255;
}

std::vector<double> numbers_after(const std::string& text, const std::string& start) {
    std::vector<double> numbers;
    const std::size_t at = text.find(start);
    if (at == std::string::npos) return numbers;
    std::string line = text.substr(at + start.size(), text.find('\n', at) - at - start.size());
    for (char& c : line)
        if (c == ',') c = ' ';
    std::istringstream words(line);
    double number = 0.0;
    while (words >> number) numbers.push_back(number);
    return numbers;
}

ClumpTemplate unlike_pellet() {
    ClumpTemplate clump;
    RandomStream random(7, 3);
    clump.rigid.name = "unlike";
    for (int i = 0; i < 24; ++i) {
        Sphere sphere;
        sphere.centre = Vec3(random.uniform(-1.0, 1.1), random.uniform(-0.8, 0.9), random.uniform(-1.1, 1.2)) * 1e-3;
        sphere.radius = random.uniform(0.31, 0.77) * 1e-3;
        clump.rigid.spheres.push_back(sphere);
    }
    MassProperties& mass = clump.rigid.mass_properties;
    mass.volume = 2.2629866e-8;
    mass.density = 1800.0;
    mass.mass = mass.volume * mass.density;
    mass.principal_inertia = Vec3(4.956584e-11, 5.452460e-11, 6.012346e-11);
    clump.rigid.bounding_radius = bounding_radius(clump.rigid.spheres);
    return clump;
}

}  // namespace pelletlab::crosscode
