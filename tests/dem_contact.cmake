# Overlap geometry, separating axes, normal contact laws.
trackbed_test(contact_overlap unit trackbed_dem)
trackbed_test(contact_separation unit trackbed_dem)
trackbed_test(contact_law verification trackbed_dem)
