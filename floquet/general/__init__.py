"""Any linear periodic system: nothing is known of it but its period."""
