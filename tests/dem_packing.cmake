# Placement of grains.
trackbed_test(packing_place unit trackbed_dem)
trackbed_test(packing_measure verification trackbed_dem)
