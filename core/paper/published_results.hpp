#pragma once

#include <array>

namespace telltale {

/// Mean and standard deviation of the paper's 20 partitions, u, v, r.
struct PublishedPartition {
  std::array<double, 3> mae;
  std::array<double, 3> mae_sd;
  std::array<double, 3> r2;
  std::array<double, 3> r2_sd;
};

/// Source: the paper's tables of MAE and R2 by separation method, static and dynamic model. The SD
/// of the dynamic model's yaw MAE by segments is printed there as 5.5 x^-4 and taken as 5.5e-4.
inline constexpr PublishedPartition kPublishedStaticBySegments = {{0.014377, 0.011913, 0.015895},
                                                                  {2.9e-3, 6.2e-4, 2.1e-3},
                                                                  {0.995708, 0.987277, 0.997468},
                                                                  {2.3e-3, 1.8e-3, 1.2e-3}};
inline constexpr PublishedPartition kPublishedStaticByPoints = {{0.011794, 0.011870, 0.015757},
                                                                {1.5e-4, 1.0e-4, 2.0e-4},
                                                                {0.997658, 0.987452, 0.997659},
                                                                {9.6e-5, 3.6e-4, 7.4e-5}};
inline constexpr PublishedPartition kPublishedDynamicBySegments = {{0.011628, 0.009654, 0.007861},
                                                                   {1.2e-3, 6.3e-4, 5.5e-4},
                                                                   {0.997505, 0.990236, 0.999523},
                                                                   {1.5e-3, 1.5e-3, 1.8e-4}};
inline constexpr PublishedPartition kPublishedDynamicByPoints = {{0.011770, 0.009414, 0.007823},
                                                                 {1.1e-4, 1.0e-4, 6.3e-5},
                                                                 {0.997776, 0.991055, 0.999551},
                                                                 {6.5e-5, 3.3e-4, 1.0e-5}};

/// One row of the paper's tables over training shares: u, v, r, on the training and validation
/// rows.
struct PublishedTrainingShare {
  double training_share;
  std::array<double, 3> training_mae;
  std::array<double, 3> mae;
  std::array<double, 3> training_r2;
  std::array<double, 3> r2;
};

/// Source: the paper's tables of MAE and R2 for training percentages, static and dynamic model.
inline constexpr std::array<PublishedTrainingShare, 3> kPublishedStaticShares = {{
    {0.7,
     {0.012234, 0.012666, 0.013471},
     {0.011092, 0.010599, 0.020743},
     {0.998177, 0.984567, 0.998602},
     {0.987774, 0.991418, 0.992662}},
    {0.6,
     {0.013645, 0.012879, 0.014153},
     {0.011370, 0.010596, 0.020164},
     {0.996305, 0.985519, 0.997190},
     {0.987496, 0.991008, 0.992628}},
    {0.5,
     {0.016374, 0.014090, 0.014068},
     {0.011580, 0.010361, 0.019268},
     {0.988801, 0.982918, 0.997262},
     {0.987273, 0.991643, 0.993209}},
}};
inline constexpr std::array<PublishedTrainingShare, 3> kPublishedDynamicShares = {{
    {0.7,
     {0.011637, 0.010785, 0.008415},
     {0.033513, 0.007386, 0.016770},
     {0.998445, 0.987943, 0.999573},
     {0.943559, 0.996225, 0.997599}},
    {0.6,
     {0.012871, 0.011076, 0.008876},
     {0.034702, 0.008325, 0.030219},
     {0.996819, 0.988532, 0.999137},
     {0.939760, 0.995190, 0.992966}},
    {0.5,
     {0.015348, 0.012492, 0.008611},
     {0.043901, 0.008154, 0.022668},
     {0.989830, 0.985986, 0.999189},
     {0.909676, 0.995331, 0.996110}},
}};

}  // namespace telltale
