// Manufactured solution: orders p+1 in L² and p in H¹.
#include <gtest/gtest.h>

#include "known/manufactured_solution.h"

using namespace trackbed::fem;

namespace {

void expect_orders(int order, Element element, int n) {
  const known::Errors coarse = known::manufactured_error(order, element, n),
                      fine = known::manufactured_error(order, element, 2 * n);
  const double value = std::log2(coarse.value / fine.value),
               gradient = std::log2(coarse.gradient / fine.gradient);
  EXPECT_NEAR(value, order + 1, 0.05);
  EXPECT_NEAR(gradient, order, 0.05);
}

}  // namespace

TEST(ManufacturedSolution, LinearElements) { expect_orders(1, Element::standard, 8); }
TEST(ManufacturedSolution, IncompatibleModes) { expect_orders(1, Element::incompatible, 8); }
TEST(ManufacturedSolution, MeanDilatation) { expect_orders(1, Element::b_bar, 8); }
TEST(ManufacturedSolution, QuadraticElements) { expect_orders(2, Element::standard, 6); }
