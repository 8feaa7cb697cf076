# Placement of grains.
trackbed_test(packing_place unit trackbed_dem)
