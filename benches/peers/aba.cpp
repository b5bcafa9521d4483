// Seconds of one call of Pinocchio's articulated-body algorithm, best of 20 times 1000 calls, for the robot of a URDF file.

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <limits>

#include <pinocchio/algorithm/aba.hpp>
#include <pinocchio/algorithm/joint-configuration.hpp>
#include <pinocchio/parsers/urdf.hpp>

int main(int, char** arguments) {
    pinocchio::Model model;
    pinocchio::urdf::buildModel(arguments[1], model);
    pinocchio::Data data(model);
    const Eigen::VectorXd q = pinocchio::neutral(model);
    Eigen::VectorXd v = Eigen::VectorXd::Constant(model.nv, 0.1);
    double best = std::numeric_limits<double>::infinity();
    for (int round = 0; round < 20; ++round) {
        const auto begun = std::chrono::steady_clock::now();
        for (int call = 0; call < 1000; ++call) {
            // Each call depends on the one before, as the stages of a step do.
            v[0] = 0.1 + 1e-12 * pinocchio::aba(model, data, q, v, v)[0];
        }
        best = std::min(best, std::chrono::duration<double>(std::chrono::steady_clock::now() - begun).count() / 1000);
    }
    std::printf("%.9g\n", best);
}
