"""What a record of the rudder is: an order or an angle, steered by hand or by the heading."""

__all__: list[str] = []
